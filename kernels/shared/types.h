// Kernel arguments, compiled by host and device alike: members of four bytes only, so that both lay them out
// alike (test/unit/compute/shared_types_test.cpp compares the layouts).
#ifndef DEPTH_FUSION_SHARED_TYPES_H
#define DEPTH_FUSION_SHARED_TYPES_H

// Values of a voxel's distance byte, and of an entry of the offset buffer.
#define TSDF_CHI (-128)       // no surface near (the paper's chi)
#define TSDF_MAX 127          // the distance +truncation
#define BLOCK_EMPTY (-1)      // no memory allocated
#define BLOCK_REQUESTED (-2)  // claimed by block selection, to be allocated by the host

// Bits of a block's state, written by TSDF fusion.
#define BLOCK_HAS_DATA 1  // some voxel is not chi
#define BLOCK_NEAR_SURFACE \
  0x1fe  // some voxel lies within a voxel's diagonal of the surface: a bit an octant of the block,
#define BLOCK_NEAR_SURFACE_SHIFT 1  // from this one on, in x, y and z
#define BLOCK_SURE 0x200            // some distance has been as sure as FusionArgs.min_certainty

// A work-item of the kernels over whole blocks takes so many voxels: one on a GPU; on a CPU a block, or a
// large block's slice.
#define VOXELS_PER_ITEM(simd_width, block_size)     \
  ((simd_width) == 1  ? 1                           \
   : (block_size) > 8 ? (block_size) * (block_size) \
                      : (block_size) * (block_size) * (block_size))

// A voxel's second byte says how sure its distance is, 1 to 255: the number of measurements, their weight, or
// by the Kalman filter a code of the variance. The code's scale is that of a float's bits, logarithmic but
// for straight lines between the powers of two: 1 stands for a standard deviation of 42 times the sensor's
// smallest, 255 for 1/24 of it (with a Kinect 50 and 0.05 mm).
#define CERTAINTY_MAX 255
#define VARIANCE_BITS_MAX 0x3b23d70a  // bits of the largest, 2.5e-3 units
#define VARIANCE_BITS_STEP 658467     // bits a step of the code
#define VARIANCE_UNIT_SIGMA_M \
  0.0012f  // the smallest sigma of a sensor whose variances count as they are, in m^2

// The rule by which a measurement changes a voxel (Algorithms 1, 2 and 3 of the paper), and how far the
// surface is taken to be from it: along the ray, from the plane through the ray's pixel, or from the plane
// through the pixel that is nearest, found by gradient steps in the depth image.
#define FUSION_AVERAGE 0
#define FUSION_WEIGHTED 1
#define FUSION_KALMAN 2
#define DISTANCE_PROJECTIVE 0
#define DISTANCE_PLANE 1
#define DISTANCE_REFINED 2

// The slots of a group, one after the other, are looked at or left out together.
#define SLOTS_PER_GROUP 64

// A work-item tests so many slots for visibility: one on a GPU; on a CPU many, which it lists with one
// atomic.
#define SLOTS_PER_ITEM(simd_width) ((simd_width) == 1 ? 1 : 16)

// Pixels per axis of the tiles with the largest depth, and with the range of the rays.
#define DEPTH_TILE 8
#define RANGE_TILE 8

// A unit normal (x, y, z) of a pixel in a word, 0 = none: its stereographic projection from (0, 0, 1), x / (1
// - z) in the low and y / (1 - z) in the high 16 bits, in steps of 1 / NORMAL_STEPS from NORMAL_ZERO on;
// within 2e-4 rad. Normals that a camera sees at up to 60 degrees beside its axis fit.
#define NORMAL_STEPS 8191.0f
#define NORMAL_ZERO 32768.0f
#define NORMAL_MAX 65535.0f

// Bits of the largest float: no depth yet, where the nearest is looked for by their order as integers.
#define NO_DEPTH_BITS 0x7f7fffff

// A tile's rays may hit in some of these bins of depth, which have a bit each.
#define DEPTH_BINS 64

// Rays are cast in patches of pixels, of which one in RAY_STRIDE in each axis makes a vector,
// RAY_PATCH_COLUMNS in a row; a work-item casts RAY_PATCHES patches side by side. Patches do not straddle
// tiles of ranges.
#define RAY_STRIDE 2
#define RAY_PATCH_COLUMNS(simd_width) ((simd_width) == 1 ? 1 : 4)
#define RAY_PATCHES(simd_width) ((simd_width) == 1 ? 1 : 4)

// An image is IMAGE_GUARD elements, then rows of `pitch` elements, then IMAGE_GUARD elements. Guards and the
// columns from width on, 16 at least, hold zeros: vectors may be loaded up to 16 elements beside the image.
#define IMAGE_GUARD 16

// A pinhole camera and the layout of its images.
typedef struct {
  float fx, fy, cx, cy;
  int width, height, pitch;
} CameraArgs;

// A lens as OpenCV and ROS describe it: k1 to k6 and p1, p2. Rays farther from the axis than the radius do
// not reach the image.
typedef struct {
  float radial[6];
  float tangential[2];
  float max_squared_radius;
} LensArgs;

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

// Says how depth images become clean depth.
typedef struct {
  float unit_m;  // metres a unit of the input
  float min_range_m, max_range_m;
} RangeArgs;

// The sensor's motion in its own frame, and when the rows of its rolling shutter are exposed: the first
// readout_s before the last, the last stamp_delay_s before the stamp.
typedef struct {
  float rotation_rad_s[3];
  float velocity_m_s[3];
  float readout_s, stamp_delay_s;
} SensorMotionArgs;

// Describes the bilateral filter, which has radius 2: the weights of columns and rows 0, 1 and 2 away, and
// the depth difference, in standard deviations of the sensor's noise, at which a neighbour counts no more.
typedef struct {
  float spatial_weights[3];
  float cutoff_sigmas;
} BilateralArgs;

// The depths that rays are cast between, and their bins.
typedef struct {
  float min_m, max_m;
  float bins_per_m;
} RayRangeArgs;

// Says where and how densely block selection samples the depth image.
typedef struct {
  int stride_px;
  float dense_from_m;  // nearer, every other sample in each axis does
  int band_samples;    // points along the ray from -truncation to +truncation, both included
  int capacity;        // of the list of requests
} SelectionArgs;

// Describes the depth sensor's noise. The axial one has sigma = base + growth (z - from)^2; the lateral one
// says how far from a pixel's ray the sensor measures.
typedef struct {
  float sigma_base_m, sigma_growth_per_m, sigma_from_m;
  float lateral_sigma_px;
  float edge_sigmas;  // beside a depth edge, times the axial sigma
} SensorArgs;

// This is the one formula of the axial sigma, for numbers and vectors, on host and device.
#define AXIAL_SIGMA_M(sensor, z) \
  ((sensor).sigma_base_m +       \
   (sensor).sigma_growth_per_m * ((z) - (sensor).sigma_from_m) * ((z) - (sensor).sigma_from_m))

// What fusion needs to know of a pixel is packed in a word: 18 bits of depth in steps, 7 bits of the cosine
// of the angle between ray and surface normal, 7 bits of the accuracy, the axial sigma over the sigma; 0 = no
// measurement.
#define MEASUREMENT_BITS 7
#define MEASUREMENT_MAX 127
#define MEASUREMENT_DEPTH_MAX 262143
#define MIN_COSINE 0.5f  // flatter rays count as this flat

// Fusion by any of the rules.
typedef struct {
  float depth_step_m;       // of the measurements
  float units_per_m2;       // of the variances below and of the filters'
  float variance_at_1m;     // for which gain and weight are given
  float gain_at_1m;         // running average: w_k
  float weight_at_1m;       // weighted: w_k
  float max_weight;         // weighted: W_max
  float process_variance;   // Kalman: Q
  float free_space_sigmas;  // how far, beyond the truncation, the surface must be behind a voxel that is free
  float free_space_kept;    // the part of its certainty that a free voxel keeps
  int min_certainty;        // below, a free voxel becomes chi
  int frame;                // number of the frame, for the rounding's dither
} FusionArgs;

// Fusion of colour.
typedef struct {
  float exposure_gain[3];  // from the image's blue, green, red to the map's
  float weight_at_1m;      // of a pixel seen head-on from 1 m; falls with the squares of depth and cosine
  float max_weight;
  float hidden_m,
      hidden_sigmas;  // a surface is hidden if the depth differs by more than this and so many sigmas
  int frame;          // number of the frame, for the rounding's dither
} ColorFusionArgs;

// Projective point-to-plane matching.
typedef struct {
  float max_distance_m;
  float min_normal_cosine;
  float huber_sigmas;  // residual, in standard deviations of the sensor, from which a match's weight falls
  int row_step;        // rows of the source from one that is matched to the next
} MatchingArgs;

// A block of a batch of the surface mesh. Only the first blocks of a batch, the core, emit; the others lend
// them their vertices. Those of the core whose own place, neighbours[0], is -1 emit vertices only.
typedef struct {
  int index[3];
  unsigned first_vertex;    // of the whole mesh
  unsigned first_triangle;  // of the batch
  int neighbours[8];        // place in the batch of the block (n & 1, n >> 1 & 1, n >> 2 & 1) farther, or -1
} MeshBlockArgs;

// Sums of the ICP system: the upper triangle of J^T w J row by row, J^T w r, w r^2, the number of inliers,
// the number of source points, the inliers' fit, the number of points that a surface of the view lies behind
// or before, w, and the upper triangle of twice the structure.
#define ICP_SUMS 54
#define ICP_FIT_SIGMAS \
  3.0f  // residual, in standard deviations of the sensor, from which on a match does not fit
#define ICP_UNIT_SIGMA_M 0.0012f  // of the sensor's sigma, where a match's weight is 1

#endif
