// Every struct of types.h and its members, for host and kernel to report how they lay them out.
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
  STRUCT(TransformArgs)                      \
  MEMBER(TransformArgs, rotation)            \
  MEMBER(TransformArgs, translation)         \
  STRUCT(GridArgs)                           \
  MEMBER(GridArgs, voxel_size_m)             \
  MEMBER(GridArgs, truncation_m)             \
  MEMBER(GridArgs, blocks_per_axis)          \
  MEMBER(GridArgs, origin)                   \
  MEMBER(GridArgs, wrapped_origin)

#endif
