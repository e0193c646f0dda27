// Converts depth images of a moving rolling shutter to what the sensor would have seen all at once, at the
// stamp. Depth 0 = none. A work-item takes SIMD_WIDTH pixels of a row.
#include "shared/image.h"

// The sensor moves at (rotation, velocity), so the point p that a row saw at `time_s` before the stamp lies
// at p + time_s * (rotation x p + velocity) in the sensor's frame at the stamp. The pixel of p, the nearest,
// is found from the depth at the pixel itself, then once more from the depth found there.
__kernel void compensate_motion(__global const float* depth, __global float* compensated, CameraArgs camera,
                                SensorMotionArgs motion) {
  const int x = get_global_id(0) * SIMD_WIDTH;
  const int y = get_global_id(1);
  if (x >= camera.width) return;
  const float time_s = motion.readout_s * ((y + 0.5f) / camera.height - 1.0f) - motion.stamp_delay_s;
  const float3 r =
      time_s * (float3)(motion.rotation_rad_s[0], motion.rotation_rad_s[1], motion.rotation_rad_s[2]);
  const float3 t = time_s * (float3)(motion.velocity_m_s[0], motion.velocity_m_s[1], motion.velocity_m_s[2]);
  const vfloat ray_x = (TO_VFLOAT(x + LANE_INDICES) - camera.cx) / camera.fx;
  const float ray_y = ((float)y - camera.cy) / camera.fy;
  vfloat z = VLOAD(depth + pixel_index(x, y, camera));
  vint found = z > 0.0f;
  for (int i = 0; i < 2; ++i) {
    const vfloat moved_x = z * (r.y - r.z * ray_y) + t.x;
    const vfloat moved_y = z * (r.z * ray_x - r.x) + t.y;
    const vfloat moved_z = z * (r.x * ray_y - r.y * ray_x) + t.z;
    const vfloat per_z = 1.0f / max(z - moved_z, (vfloat)(1e-3f));
    const vfloat u = camera.fx * (z * ray_x - moved_x) * per_z + camera.cx + 0.5f;
    const vfloat v = camera.fy * (z * ray_y - moved_y) * per_z + camera.cy + 0.5f;
    found = found & (u >= 0.0f) & (v >= 0.0f) & (u < (float)camera.width) & (v < (float)camera.height);
    const vint column = TO_VINT(select((vfloat)(0.0f), u, found));
    const vint row = TO_VINT(select((vfloat)(0.0f), v, found));
    const vfloat source = GATHER(vfloat, depth, pixel_indices(column, row, camera));
    found = found & (source > 0.0f);
    z = select(z, source + moved_z, found);
  }
  VSTORE(select((vfloat)(0.0f), z, found), compensated + pixel_index(x, y, camera));
}
