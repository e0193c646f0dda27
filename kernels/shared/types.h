// Kernel arguments, compiled by host and device alike: members of four bytes only, so that both lay them out alike
// (test/unit/shared_types_test.cpp compares the layouts).
#ifndef DEPTH_FUSION_SHARED_TYPES_H
#define DEPTH_FUSION_SHARED_TYPES_H

// Values of a voxel's distance byte, and of an entry of the offset buffer.
#define TSDF_CHI (-128)        // no surface near (the paper's chi)
#define TSDF_MAX 127           // the distance +truncation
#define BLOCK_EMPTY (-1)       // no memory allocated
#define BLOCK_REQUESTED (-2)   // claimed by block selection, to be allocated by the host

// Bits of a block's state, written by TSDF fusion.
#define BLOCK_HAS_DATA 1       // some voxel is not chi
#define BLOCK_NEAR_SURFACE 2   // some voxel lies within a voxel's diagonal of the surface

// Images are planar, IMAGE_GUARD elements, then rows of `pitch` elements, then IMAGE_GUARD elements. Guards and the
// columns from width on, 16 at least, hold zeros: vectors may be loaded up to 16 elements beside the image.
#define IMAGE_GUARD 16

// A pinhole camera and the layout of its images.
typedef struct {
  float fx, fy, cx, cy;
  int width, height, pitch;
} CameraArgs;

// p_A = rotation * p_B + translation, row by row.
typedef struct {
  float rotation[9];
  float translation[3];
} TransformArgs;

// The window of blocks_per_axis^3 blocks of block_size^3 voxels. Voxel (i, j, k) samples the point
// voxel_size_m * (i, j, k) of W. A block's address wraps around: index modulo blocks_per_axis in each axis.
typedef struct {
  float voxel_size_m;
  float truncation_m;
  int blocks_per_axis;
  int origin[3];          // first block of the window
  int wrapped_origin[3];  // origin modulo blocks_per_axis
} GridArgs;

// How depth images become clean depth.
typedef struct {
  float unit_m;                  // metres a unit of the input
  float min_range_m, max_range_m;
} RangeArgs;

// The sensor's motion in its own frame, and when the rows of its rolling shutter are exposed: the first readout_s before
// the last, the last stamp_delay_s before the stamp.
typedef struct {
  float rotation_rad_s[3];
  float velocity_m_s[3];
  float readout_s, stamp_delay_s;
} SensorMotionArgs;

// Bilateral filter of radius 2: weights of columns and rows 0, 1 and 2 away, and the depth difference, in standard
// deviations of the sensor's noise, at which a neighbour counts no more.
typedef struct {
  float spatial_weights[3];
  float cutoff_sigmas;
} BilateralArgs;

// Where and how densely block selection samples the depth image.
typedef struct {
  int stride_px;
  int band_samples;  // points along the ray from -truncation to +truncation, both included
  int capacity;      // of the list of requests
} SelectionArgs;

// Weighted fusion (Algorithm 2 of the paper).
typedef struct {
  float weight_at_1m;  // of a measurement at 1 m; falls with the square of the depth
  float min_weight, max_measurement_weight;
  float max_weight;    // W_max
  int frame;           // number of the frame, for the rounding's dither
} FusionArgs;

// Fusion of colour.
typedef struct {
  float exposure_gain[3];  // from the image's blue, green, red to the map's
  float weight_at_1m;      // of a pixel seen head-on from 1 m; falls with the squares of depth and cosine
  float max_weight;
  float hidden_m, hidden_sigmas;  // a surface is hidden if the depth differs by more than this and so many sigmas
  int frame;                      // number of the frame, for the rounding's dither
} ColorFusionArgs;

// Projective point-to-plane matching.
typedef struct {
  float max_distance_m;
  float min_normal_cosine;
  float huber_sigmas;  // residual, in standard deviations of the sensor, from which a match's weight falls
  int source_plane, model_plane;  // elements from one component of the normals to the next
} MatchingArgs;

// A block of a batch of the surface mesh. Only the first blocks of a batch, the core, emit; the others lend them their
// vertices.
typedef struct {
  int index[3];
  unsigned first_vertex;    // of the whole mesh
  unsigned first_triangle;  // of the batch
  int neighbours[8];        // place in the batch of the block (n & 1, n >> 1 & 1, n >> 2 & 1) farther, -1 if not there
} MeshBlockArgs;

// Sums of the ICP system: the upper triangle of J^T w J row by row, J^T w r, w r^2, the number of inliers, and the
// number of source points.
#define ICP_SUMS 30

// The sensor's axial noise, one standard deviation in metres (Nguyen et al. 2012): a + b (z - c)^2.
#define SENSOR_SIGMA_A 0.0012f
#define SENSOR_SIGMA_B 0.0019f
#define SENSOR_SIGMA_C 0.4f

#endif
