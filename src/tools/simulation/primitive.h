// Solids with an exact signed distance function, and the procedural textures on them.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

enum class Pattern {
  kPlain,     // one colour
  kSpeckles,  // soft spots of several sizes
  kTiles,     // cells of random brightness: many corners
  kWood,      // grain along x
  kRepeated,  // one cell of kTiles, again and again
  kMottle,    // spots of every size down to scale / 16, no two places alike: corners everywhere
};

enum class Optics {
  kOpaque,
  kMirror,  // shows what it reflects, as far away as the light has come
  kGlass,   // shows what is behind it; seen aslant, without depth
};

struct Material {
  Eigen::Vector3d color_bgr = Eigen::Vector3d::Constant(180.0);  // mean colour, 0..255
  Pattern pattern = Pattern::kPlain;
  double scale_m = 0.1;   // size of the pattern's largest feature
  double contrast = 0.5;  // 0: plain; 1: from black to twice the mean
  bool shaded = true;     // false: as bright on every side
  Optics optics = Optics::kOpaque;
};

// Returns the colour at a point (B, G, R in 0..255); the texture fills space, and a surface cuts through it.
Eigen::Vector3d textureColor(const Material& material, const Eigen::Vector3d& p_W);

enum class Shape {
  kBox,
  kRoom,      // the inside of a box
  kSphere,    // radius half_size.x
  kCylinder,  // along z with flat ends, radius half_size.x, half height half_size.z
  kCapsule,   // along z with round ends, radius half_size.x, half height without the ends half_size.z
  kTorus,     // around z, radius half_size.x to the middle of the tube, whose radius is half_size.z
  kPlane,     // z = 0, free space above
};

// A solid in its own frame S, centred at the origin.
class Primitive {
 public:
  Primitive(Shape shape, const Pose& T_W_S, const Eigen::Vector3d& half_size_m, const Material& material,
            double rounding_m = 0.0);

  // Returns the Euclidean distance to the surface in metres, negative inside the solid.
  double distance(const Eigen::Vector3d& p_W) const;
  // Returns the unit vector away from the surface, which is the gradient of distance().
  Eigen::Vector3d normal(const Eigen::Vector3d& p_W) const;

  // Returns the range at which a ray (of unit length, from free space) first meets the surface, if that is
  // before max_range_m.
  std::optional<double> firstHit(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& ray_W,
                                 double max_range_m) const;

  const Material& material() const { return material_; }
  void paint(const Material& material) { material_ = material; }
  // Rounds the centre to 2^-20 m and moves it. Copies that are moved by different multiples of that are seen
  // alike, bit for bit, from poses that are moved with them.
  void moveOnGrid(const Eigen::Vector3d& by_W);
  // Texture and light are those of a world L, W unless said. A copy that stands elsewhere has the colours of
  // the first if its L is moved with it.
  void setLook(const Pose& T_L_W) { T_L_W_ = T_L_W; }
  const Pose& T_L_W() const { return T_L_W_; }
  // Returns a copy that is moved together with its L.
  Primitive moved(const Pose& T_W_moved) const;
  // A box that holds the solid; infinite for rooms and planes.
  Eigen::AlignedBox3d boundingBox_W() const;

 private:
  struct Interval {
    double begin_m, end_m;
  };

  Eigen::Vector3d extentInS() const;
  double distanceInS(const Eigen::Vector3d& p_S) const;
  // Returns the part of a ray that can hold the first hit; it is empty if its end lies before its begin.
  Interval hitInterval(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& ray_S) const;

  Shape shape_;
  Pose T_W_S_;
  Eigen::Matrix3d R_S_W_;
  Eigen::Vector3d half_size_m_;
  Material material_;
  double rounding_m_;  // of a box's edges
  Pose T_L_W_ = Pose::Identity();
};

// These are shorthands for building scenes. Positions and full sizes are in metres; `yaw_rad` turns about z.
Primitive box(const Eigen::Vector3d& centre_W, const Eigen::Vector3d& size_m, const Material& material,
              double yaw_rad = 0.0, double rounding_m = 0.0);
Primitive room(const Eigen::Vector3d& centre_W, const Eigen::Vector3d& size_m, const Material& material);
Primitive sphere(const Eigen::Vector3d& centre_W, double radius_m, const Material& material);
Primitive cylinder(const Eigen::Vector3d& bottom_W, const Eigen::Vector3d& top_W, double radius_m,
                   const Material& material);
Primitive capsule(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W, double radius_m,
                  const Material& material);
// Makes a ring around axis_W.
Primitive torus(const Eigen::Vector3d& centre_W, const Eigen::Vector3d& axis_W, double radius_m,
                double tube_radius_m, const Material& material);
Primitive plane(const Eigen::Vector3d& point_W, const Eigen::Vector3d& normal_W, const Material& material);

}  // namespace depth_fusion
