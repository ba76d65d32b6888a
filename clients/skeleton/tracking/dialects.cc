#include "clients/skeleton/tracking/dialects.h"

#include <algorithm>
#include <array>

namespace footing::skeleton {
namespace {

constexpr std::array<std::string_view, kDialects> kDialectNames = {
    "sensebloom", "quartz", "zillode", "kinect-sdk2", "footing", "vmc"};
constexpr std::array<std::string_view, 5> kUnitNames = {"dialect", "normalised", "mm", "cm", "m"};

template <typename Enum, std::size_t N>
std::optional<Enum> Find(const std::array<std::string_view, N>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

Units UnitsOf(Dialect dialect, const DialectOptions& options) {
  if (options.units != Units::kOfDialect) return options.units;
  switch (dialect) {
    case Dialect::kSensebloom:
    case Dialect::kQuartz:
      return Units::kNormalised;
    case Dialect::kZillode:
    case Dialect::kKinectSdk2:
      return Units::kMillimetres;
    case Dialect::kFooting:
    case Dialect::kVmc:
      break;
  }
  return Units::kMetres;
}

/// Numbers times scale plus shift are metres in the dialect's own frame.
struct Linear {
  Eigen::Array3d scale, shift;
};

Linear ToMetres(Units units) {
  switch (units) {
    case Units::kNormalised:
      return {{-2.56, -1.92, 1.28}, {1.28, 0.96, 0}};
    case Units::kMillimetres:
      return {Eigen::Array3d::Constant(1e-3), Eigen::Array3d::Zero()};
    case Units::kCentimetres:
      return {Eigen::Array3d::Constant(1e-2), Eigen::Array3d::Zero()};
    case Units::kOfDialect:
    case Units::kMetres:
      break;
  }
  return {Eigen::Array3d::Ones(), Eigen::Array3d::Zero()};
}

/// The dialect's axes along K's: OpenNI has x to the camera's right; KinectSDK2 has Kinect's axes,
/// which are K's, with y negated; VMC has those of Unity (x to the person's right, y up, z where
/// the person looks), and the camera stands in front of the person.
Eigen::Array3d Signs(Dialect dialect, const DialectOptions& options) {
  Eigen::Array3d signs = Eigen::Array3d::Ones();
  switch (dialect) {
    case Dialect::kSensebloom:
    case Dialect::kQuartz:
    case Dialect::kZillode:
      signs.x() = -1;
      break;
    case Dialect::kKinectSdk2:
      signs.y() = -1;
      break;
    case Dialect::kVmc:
      signs.z() = -1;
      break;
    case Dialect::kFooting:
      break;
  }
  if (options.flip_y) signs.y() = -signs.y();
  return signs;
}

}  // namespace

std::string_view NameOf(Dialect dialect) {
  return kDialectNames[static_cast<std::size_t>(dialect)];
}
std::optional<Dialect> DialectOf(std::string_view name) {
  return Find<Dialect>(kDialectNames, name);
}
std::string_view NameOf(Units units) { return kUnitNames[static_cast<std::size_t>(units)]; }
std::optional<Units> UnitsOf(std::string_view name) { return Find<Units>(kUnitNames, name); }

Skeleton WithSides(const DialectOptions& options, const Skeleton& skeleton) {
  const Skeleton sides = options.swap_sides ? SwappedSides(skeleton) : skeleton;
  return options.mirrored ? MirrorImage(sides) : sides;
}

Eigen::Vector3d ToCamera(Dialect dialect, const DialectOptions& options,
                         const Eigen::Vector3d& numbers) {
  const Linear linear = ToMetres(UnitsOf(dialect, options));
  const Eigen::Array3d plain = (numbers - options.offset).array() / options.factor.array();
  return (Signs(dialect, options) * (plain * linear.scale + linear.shift)).matrix();
}

Eigen::Vector3d FromCamera(Dialect dialect, const DialectOptions& options,
                           const Eigen::Vector3d& p_K_m) {
  const Linear linear = ToMetres(UnitsOf(dialect, options));
  const Eigen::Array3d plain =
      (Signs(dialect, options) * p_K_m.array() - linear.shift) / linear.scale;
  return (plain * options.factor.array()).matrix() + options.offset;
}

}  // namespace footing::skeleton
