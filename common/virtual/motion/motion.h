#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/table.h"

/// Recorded movement: files of motion capture and of force plates, as plain values in SI.
namespace footing::motion {

// C3D: markers, analog channels and force plates of a laboratory in one binary file (www.c3d.org),
// written by Intel, DEC or MIPS processors, as 16-bit integers or floats.

/// One force plate as the file describes it.
struct C3dPlate {
  int type = 0;
  Eigen::Matrix<double, 3, 4> corners = Eigen::Matrix<double, 3, 4>::Zero();  ///< m, file's axes.
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< To the surface's middle, plate's axes.
  std::vector<int> channels;                           ///< Into `analog`, from 0.
};

/// Contents of a C3D file: markers, analog channels and force plates.
struct C3d {
  MarkerTracks points;  ///< In the file's axes. Labels that are missing are "point 1", ...
  double analog_rate_hz = 0;
  std::vector<std::string> analog_names;
  std::vector<std::string> analog_units;
  Eigen::MatrixXd analog;  ///< Channels x samples, scaled as the file says, in its units.
  std::vector<C3dPlate> plates;
  /// POINT:X_SCREEN and Y_SCREEN, such as "+X" and "+Z" (up); empty where the file has none.
  std::string x_screen, y_screen;
};

/// Reads one. `file` is its name for errors, which say where and what was expected.
Result<C3d> ParseC3d(std::span<const std::uint8_t> bytes, const std::string& file);

/// A file of floats for Intel processors, in millimetres, readable by ParseC3d(). The analog rate
/// is a whole multiple of the points' rate. Points that are not seen are marked so. InvalidData
/// where no frame is there, or more is there than a file can hold.
Result<std::string> WriteC3d(const C3d& c3d);

/// Forces on the person at the analog rate, in the file's axes: plates of type 2 (three forces,
/// three moments about the origin) and 4 (the same; its channels must be calibrated already).
/// Others are an error that names the type.
Result<GroundForces> ToGroundForces(const C3d& c3d, const std::string& file);

/// Limits of every reader, checked before memory is taken.
inline constexpr std::size_t kMostJoints = 1024;
inline constexpr std::size_t kMostDepth = 128;
inline constexpr std::size_t kMostColumns = 8192;
inline constexpr std::size_t kMostValues = 1u << 26;  ///< Frames times columns: 512 MiB.

/// A skeleton through time, one pose a column, at equal steps.
struct Motion {
  body::Skeleton skeleton;
  double rate_hz = 0;
  double start_s = 0;  ///< Time of the first frame on the recording's own clock.
  Eigen::MatrixXd q;   ///< dof x frames: m and rad.

  Eigen::Index frames() const { return q.cols(); }
  double duration_s() const { return rate_hz > 0 ? static_cast<double>(q.cols()) / rate_hz : 0; }
};

inline constexpr std::size_t kC3dBlock = 512;   ///< Sections begin at multiples of it.
inline constexpr std::uint8_t kC3dMark = 0x50;  ///< Second byte of the file.

/// Which machine wrote a C3D file; the number is what the file has for it.
enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };

/// Numbers out of the bytes of a C3D file. The caller has checked that they are there.
class C3dReader {
 public:
  C3dReader(std::span<const std::uint8_t> bytes, Processor processor)
      : bytes_(bytes), processor_(processor) {}

  bool Has(std::size_t at, std::size_t count) const {
    return at <= bytes_.size() && count <= bytes_.size() - at;
  }
  std::uint8_t Byte(std::size_t at) const { return bytes_[at]; }
  std::uint16_t Unsigned(std::size_t at) const {
    const unsigned first = bytes_[at], second = bytes_[at + 1];
    return static_cast<std::uint16_t>(processor_ == Processor::kMips ? first << 8 | second
                                                                     : second << 8 | first);
  }
  std::int16_t Signed(std::size_t at) const { return static_cast<std::int16_t>(Unsigned(at)); }
  float Float(std::size_t at) const {
    const std::uint32_t first = Unsigned(at), second = Unsigned(at + 2);
    if (processor_ == Processor::kIntel) return std::bit_cast<float>(second << 16 | first);
    if (processor_ == Processor::kMips) return std::bit_cast<float>(first << 16 | second);
    // DEC: the high word first, and an exponent that is two more.
    return std::bit_cast<float>(first << 16 | second) / 4;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  Processor processor_;
};

/// The same movement of a skeleton with legs (body::FindLandmarks) whose knee is a hinge, without
/// thighs that turn by half a turn about themselves from one frame to the next. Beyond full flexion
/// a fit to markers can take the other solution: the thigh turned by half a turn and the knee bent
/// the other way. Hip, knee and ankle are at the same places; the foot is turned to where it was as
/// nearly as its angles allow. Each frame takes the solution whose hip is nearer to the frame
/// before. Other skeletons are returned as they are.
Motion WithoutHalfTurns(Motion motion);

/// The parameter section of a C3D file: "GROUP:NAME" in capitals to its values.
struct C3dParameters {
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::vector<std::string>> texts;

  /// The first value, or `otherwise`.
  double Number(const std::string& name, double otherwise) const;
  std::string Text(const std::string& name) const;
  /// LABELS, LABELS2, LABELS3, ... in one list.
  std::vector<std::string> Labels(const std::string& group) const;
};

/// Reads the section that begins at byte `begin`.
Result<C3dParameters> ParseC3dParameters(const C3dReader& reader, std::size_t begin,
                                         const std::string& file);

}  // namespace footing::motion
