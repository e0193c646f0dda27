// Every struct of types.h and of esdf/types.h and its members, for host and kernel to report how they lay
// them out.
#ifndef DEPTH_FUSION_SHARED_TYPES_LAYOUT_H
#define DEPTH_FUSION_SHARED_TYPES_LAYOUT_H

#define FOR_EACH_SHARED_TYPE(STRUCT, MEMBER) \
  STRUCT(CameraArgs)                         \
  MEMBER(CameraArgs, fx)                     \
  MEMBER(CameraArgs, fy)                     \
  MEMBER(CameraArgs, cx)                     \
  MEMBER(CameraArgs, cy)                     \
  MEMBER(CameraArgs, width)                  \
  MEMBER(CameraArgs, height)                 \
  MEMBER(CameraArgs, pitch)                  \
  STRUCT(LensArgs)                           \
  MEMBER(LensArgs, radial)                   \
  MEMBER(LensArgs, tangential)               \
  MEMBER(LensArgs, max_squared_radius)       \
  STRUCT(TransformArgs)                      \
  MEMBER(TransformArgs, rotation)            \
  MEMBER(TransformArgs, translation)         \
  STRUCT(GridArgs)                           \
  MEMBER(GridArgs, voxel_size_m)             \
  MEMBER(GridArgs, truncation_m)             \
  MEMBER(GridArgs, blocks_per_axis)          \
  MEMBER(GridArgs, origin)                   \
  MEMBER(GridArgs, wrapped_origin)           \
  STRUCT(RangeArgs)                          \
  MEMBER(RangeArgs, unit_m)                  \
  MEMBER(RangeArgs, min_range_m)             \
  MEMBER(RangeArgs, max_range_m)             \
  STRUCT(SensorMotionArgs)                   \
  MEMBER(SensorMotionArgs, rotation_rad_s)   \
  MEMBER(SensorMotionArgs, velocity_m_s)     \
  MEMBER(SensorMotionArgs, readout_s)        \
  MEMBER(SensorMotionArgs, stamp_delay_s)    \
  STRUCT(BilateralArgs)                      \
  MEMBER(BilateralArgs, spatial_weights)     \
  MEMBER(BilateralArgs, cutoff_sigmas)       \
  STRUCT(RayRangeArgs)                       \
  MEMBER(RayRangeArgs, min_m)                \
  MEMBER(RayRangeArgs, max_m)                \
  MEMBER(RayRangeArgs, bins_per_m)           \
  STRUCT(SelectionArgs)                      \
  MEMBER(SelectionArgs, stride_px)           \
  MEMBER(SelectionArgs, dense_from_m)        \
  MEMBER(SelectionArgs, band_samples)        \
  MEMBER(SelectionArgs, capacity)            \
  STRUCT(SensorArgs)                         \
  MEMBER(SensorArgs, sigma_base_m)           \
  MEMBER(SensorArgs, sigma_growth_per_m)     \
  MEMBER(SensorArgs, sigma_from_m)           \
  MEMBER(SensorArgs, lateral_sigma_px)       \
  MEMBER(SensorArgs, edge_sigmas)            \
  STRUCT(FusionArgs)                         \
  MEMBER(FusionArgs, depth_step_m)           \
  MEMBER(FusionArgs, units_per_m2)           \
  MEMBER(FusionArgs, variance_at_1m)         \
  MEMBER(FusionArgs, gain_at_1m)             \
  MEMBER(FusionArgs, weight_at_1m)           \
  MEMBER(FusionArgs, max_weight)             \
  MEMBER(FusionArgs, process_variance)       \
  MEMBER(FusionArgs, free_space_sigmas)      \
  MEMBER(FusionArgs, free_space_kept)        \
  MEMBER(FusionArgs, min_certainty)          \
  MEMBER(FusionArgs, frame)                  \
  STRUCT(ColorFusionArgs)                    \
  MEMBER(ColorFusionArgs, exposure_gain)     \
  MEMBER(ColorFusionArgs, weight_at_1m)      \
  MEMBER(ColorFusionArgs, max_weight)        \
  MEMBER(ColorFusionArgs, hidden_m)          \
  MEMBER(ColorFusionArgs, hidden_sigmas)     \
  MEMBER(ColorFusionArgs, frame)             \
  STRUCT(MatchingArgs)                       \
  MEMBER(MatchingArgs, max_distance_m)       \
  MEMBER(MatchingArgs, min_normal_cosine)    \
  MEMBER(MatchingArgs, huber_sigmas)         \
  MEMBER(MatchingArgs, row_step)             \
  STRUCT(MeshBlockArgs)                      \
  MEMBER(MeshBlockArgs, index)               \
  MEMBER(MeshBlockArgs, first_vertex)        \
  MEMBER(MeshBlockArgs, first_triangle)      \
  MEMBER(MeshBlockArgs, neighbours)          \
  STRUCT(EsdfArgs)                           \
  MEMBER(EsdfArgs, cell_m)                   \
  MEMBER(EsdfArgs, voxel_m)                  \
  MEMBER(EsdfArgs, truncation_m)             \
  MEMBER(EsdfArgs, cell_voxels)              \
  MEMBER(EsdfArgs, surface_steps)            \
  MEMBER(EsdfArgs, reach)                    \
  MEMBER(EsdfArgs, max_distance_m)           \
  MEMBER(EsdfArgs, steps_per_m)              \
  MEMBER(EsdfArgs, hidden_m)                 \
  STRUCT(EsdfRegionArgs)                     \
  MEMBER(EsdfRegionArgs, blocks)             \
  MEMBER(EsdfRegionArgs, first)              \
  MEMBER(EsdfRegionArgs, size)

#endif
