// One ICP iteration: matching, rejection and the first reduction of the point-to-plane system (the paper's
// section "Registration"). A work-group takes one of the source's rows, every row_step-th; its sums go to
// partial_sums[group * ICP_SUMS + i].
//   source_*  depth and normals (shared/normal.h) of the current frame, camera `source`
//   model_*   depth and normals of the model view, camera `model`
// A match fits by 1 - (r / (ICP_FIT_SIGMAS sigma))^2, at least 0 (the score of MSAC: P. Torr, A. Zisserman,
// "MLESAC", CVIU 2000).
// Residual r = n . (T p - q); Jacobian with respect to the twist (rotation, translation) applied on the left
// of T: J = [(T p) x n, n], n the model's normal. In J^T w J the squared errors of n make motions along a
// bare wall look determined. The structure is the mean of J^T w Js and its transpose, Js = [(T p) x s, s], s
// the source's normal: the errors of n and s are independent, and their products vanish in the sum
// (instrumental variables: T. Soderstrom, "Errors-in-variables methods in system identification", 2018). It
// is taken over all points that are near enough and face the same way: to keep only those whose normals agree
// would pair alike errors.
#include "shared/image.h"
#include "shared/normal.h"
#ifndef GROUP_SIZE
#define GROUP_SIZE 1
#endif

__kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void accumulate_system(
    __global const float* source_depth, __global const uint* source_normals,
    __global const float* model_depth, __global const uint* model_normals, __global float* partial_sums,
    CameraArgs source, CameraArgs model, TransformArgs T_M_D, SensorArgs sensor, MatchingArgs args) {
  const int group = get_group_id(0);
  const int row = group * args.row_step;
  const int item = get_local_id(0);
  vfloat sums[ICP_SUMS];
  for (int i = 0; i < ICP_SUMS; ++i) sums[i] = 0.0f;

  const float ray_y = (row - source.cy) / source.fy;
  for (int x = item * SIMD_WIDTH; x < source.width; x += GROUP_SIZE * SIMD_WIDTH) {
    const int index = pixel_index(x, row, source);
    const vfloat depth = VLOAD(source_depth + index);
    const vuint source_normal = VLOAD(source_normals + index);
    vint inlier = (depth > 0.0f) & (source_normal != 0);
    if (!ANY(inlier)) continue;
    sums[29] += select((vfloat)(0.0f), (vfloat)(1.0f), inlier);

    const vfloat ray_x = (TO_VFLOAT(x + LANE_INDICES) - source.cx) / source.fx;
    const vfloat px = rotated(T_M_D, 0, ray_x, ray_y, 1.0f) * depth + T_M_D.translation[0];
    const vfloat py = rotated(T_M_D, 1, ray_x, ray_y, 1.0f) * depth + T_M_D.translation[1];
    const vfloat pz = rotated(T_M_D, 2, ray_x, ray_y, 1.0f) * depth + T_M_D.translation[2];
    const vfloat per_z = 1.0f / pz;
    const vint u = TO_VINT(floor(model.fx * px * per_z + (model.cx + 0.5f)));
    const vint v = TO_VINT(floor(model.fy * py * per_z + (model.cy + 0.5f)));
    inlier = inlier & (pz > 0.0f) & (u >= 0) & (u < model.width) & (v >= 0) & (v < model.height);
    if (!ANY(inlier)) continue;

    const vint match = select((vint)(0), pixel_indices(u, v, model), inlier);
    const vfloat qz = GATHER(vfloat, model_depth, match);
    const vuint model_normal = GATHER(vuint, model_normals, match);
    const Normals s = unpack_normals(source_normal);
    const Normals n = unpack_normals(model_normal);
    const vfloat dx = px - (TO_VFLOAT(u) - model.cx) / model.fx * qz;
    const vfloat dy = py - (TO_VFLOAT(v) - model.cy) / model.fy * qz;
    const vfloat dz = pz - qz;
    const vfloat sx = rotated(T_M_D, 0, s.x, s.y, s.z);
    const vfloat sy = rotated(T_M_D, 1, s.x, s.y, s.z);
    const vfloat sz = rotated(T_M_D, 2, s.x, s.y, s.z);
    const vfloat cosine = n.x * sx + n.y * sy + n.z * sz;
    inlier = inlier & (qz > 0.0f) & (model_normal != 0);
    sums[31] += select((vfloat)(0.0f), (vfloat)(1.0f), inlier);
    const vint near =
        inlier & (dx * dx + dy * dy + dz * dz < args.max_distance_m * args.max_distance_m) & (cosine > 0.0f);
    if (!ANY(near)) continue;
    inlier = near & (cosine > args.min_normal_cosine);

    const vfloat residual = n.x * dx + n.y * dy + n.z * dz;
    const vfloat sigma_m = AXIAL_SIGMA_M(sensor, depth);
    const vfloat huber =
        min(args.huber_sigmas * sigma_m / max(fabs(residual), (vfloat)(1e-6f)), (vfloat)(1.0f));
    const vfloat weight_near =
        select((vfloat)(0.0f), huber * (ICP_UNIT_SIGMA_M * ICP_UNIT_SIGMA_M) / (sigma_m * sigma_m), near);
    const vfloat weight = select((vfloat)(0.0f), weight_near, inlier);
    const vfloat jacobian[6] = {py * n.z - pz * n.y, pz * n.x - px * n.z, px * n.y - py * n.x, n.x, n.y, n.z};
    const vfloat of_source[6] = {py * sz - pz * sy, pz * sx - px * sz, px * sy - py * sx, sx, sy, sz};
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      const vfloat weighted = select((vfloat)(0.0f), weight * jacobian[i], inlier);
      const vfloat near_of_model = select((vfloat)(0.0f), weight_near * jacobian[i], near);
      const vfloat near_of_source = select((vfloat)(0.0f), weight_near * of_source[i], near);
      for (int j = i; j < 6; ++j) {
        sums[k] += weighted * jacobian[j];
        sums[33 + k++] += near_of_model * of_source[j] + near_of_source * jacobian[j];
      }
      sums[21 + i] += weighted * residual;
    }
    sums[27] += select((vfloat)(0.0f), weight * residual * residual, inlier);
    sums[32] += weight;
    sums[28] += select((vfloat)(0.0f), (vfloat)(1.0f), inlier);
    const vfloat sigmas = residual / (ICP_FIT_SIGMAS * sigma_m);
    sums[30] += select((vfloat)(0.0f), max(1.0f - sigmas * sigmas, (vfloat)(0.0f)), inlier);
  }

#if GROUP_SIZE == 1
  for (int i = 0; i < ICP_SUMS; ++i) partial_sums[group * ICP_SUMS + i] = SUM_LANES(sums[i]);
#else
  __local float shared_sums[GROUP_SIZE];
  for (int i = 0; i < ICP_SUMS; ++i) {
    shared_sums[item] = SUM_LANES(sums[i]);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int half_size = GROUP_SIZE / 2; half_size > 0; half_size /= 2) {
      if (item < half_size) shared_sums[item] += shared_sums[item + half_size];
      barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (item == 0) partial_sums[group * ICP_SUMS + i] = shared_sums[0];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
#endif
}
