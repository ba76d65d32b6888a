#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/skeleton/tracking/joints.h"

/// What programs that send skeletons by OSC mean by their messages (docs/skeleton.md has each in
/// bytes). Read from the sources of Sensebloom/OSCeleton, Zillode/OSCeleton-OpenNI and
/// Zillode/OSCeleton-KinectSDK2; the Virtual Motion Capture protocol from its specification.
namespace footing::skeleton {

enum class Dialect : std::uint8_t {
  kSensebloom,  ///< /joint ,sifff
  kQuartz,      ///< /joint/NAME/USER ,fff
  kZillode,     ///< /joint ,siiffffd
  kKinectSdk2,  ///< /osceleton2/joint ,siiffffd, one a packet
  kFooting,     ///< /footing/skeleton and /footing/joint
  kVmc,         ///< /VMC/Ext/Bone/Pos
};
inline constexpr std::size_t kDialects = 6;

std::string_view NameOf(Dialect dialect);
std::optional<Dialect> DialectOf(std::string_view name);

/// What a dialect's three numbers are.
enum class Units : std::uint8_t {
  kOfDialect,   ///< Normalised for kSensebloom and kQuartz, metres for kFooting and kVmc, else mm.
  kNormalised,  ///< OSCeleton's: x = (1280 - X)/2560, y = (960 - Y)/1920, z = Z/1280, in mm.
  kMillimetres,
  kCentimetres,
  kMetres,
};

std::string_view NameOf(Units units);
std::optional<Units> UnitsOf(std::string_view name);

/// How a sender was started; OSCeleton's -mx, -my, -mz and -ox, -oy, -oz.
struct DialectOptions {
  Units units = Units::kOfDialect;
  Eigen::Vector3d factor = Eigen::Vector3d::Ones();  ///< Not 0.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  bool flip_y = false;    ///< The sender's y points the other way than its dialect's.
  bool mirrored = false;  ///< The sender shows a mirror image: negate x, swap left and right.
  /// The sender swaps the names of left and right. With `mirrored` only x is negated.
  bool swap_sides = false;
};

/// A sender's skeleton with its sides put right, and back.
Skeleton WithSides(const DialectOptions& options, const Skeleton& skeleton);

/// A dialect's numbers to metres in K, and back.
Eigen::Vector3d ToCamera(Dialect dialect, const DialectOptions& options,
                         const Eigen::Vector3d& numbers);
Eigen::Vector3d FromCamera(Dialect dialect, const DialectOptions& options,
                           const Eigen::Vector3d& p_K_m);

/// A skeleton as the packets that a sender of the dialect would send. What the dialect cannot say
/// is lost: confidences below 0.5 (kSensebloom, kQuartz) or 0.1 (kZillode) leave a joint out,
/// kKinectSdk2 knows 1, 0.5 and 0.1, and only it, kZillode and kFooting have a time. kVmc is not
/// written: nothing.
std::vector<std::string> Encode(Dialect dialect, const DialectOptions& options,
                                const Skeleton& skeleton);

}  // namespace footing::skeleton
