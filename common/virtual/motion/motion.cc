#include "common/virtual/motion/motion.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/landmarks.h"
#include "common/virtual/motion/table.h"

namespace footing::motion {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Layout of the data by the header block and the parameters.
struct Layout {
  std::size_t points = 0, frames = 0;
  std::size_t analog_channels = 0, analog_per_frame = 0;
  double scale = 0;  ///< Scale of integers; floats need none.
  bool floats = false;
  std::size_t data_begin = 0;
  double rate_hz = 0;

  std::size_t word() const { return floats ? 4 : 2; }
  std::size_t frame_bytes() const {
    return word() * (4 * points + analog_channels * analog_per_frame);
  }
};

Result<Layout> ToLayout(const C3dReader& reader, const C3dParameters& parameters,
                        std::size_t file_bytes, const std::string& file) {
  Layout layout;
  const auto fault = [&file](const std::string& what) { return InvalidData(file + ": " + what); };
  layout.points = reader.Unsigned(2);
  const std::size_t analog_words = reader.Unsigned(4);
  const std::size_t first = reader.Unsigned(6), last = reader.Unsigned(8);
  layout.frames = last >= first ? last - first + 1 : 0;
  layout.scale = static_cast<double>(reader.Float(12));
  layout.analog_per_frame = reader.Unsigned(18);
  layout.rate_hz = parameters.Number("POINT:RATE", static_cast<double>(reader.Float(20)));
  // Numbers of more than 16 bits stand in two words, low first.
  const auto start = parameters.numbers.find("TRIAL:ACTUAL_START_FIELD");
  const auto end = parameters.numbers.find("TRIAL:ACTUAL_END_FIELD");
  const auto wide = [](const std::vector<double>& words) {
    const auto word = [&words](std::size_t i) {
      if (i >= words.size()) return std::uint16_t{0};
      return static_cast<std::uint16_t>(static_cast<int>(std::clamp(words[i], -32768.0, 65535.0)));
    };
    return static_cast<std::size_t>(word(0)) | static_cast<std::size_t>(word(1)) << 16;
  };
  if (start != parameters.numbers.end() && end != parameters.numbers.end() &&
      wide(end->second) >= wide(start->second)) {
    layout.frames = wide(end->second) - wide(start->second) + 1;
  }
  layout.floats = layout.scale < 0 || std::signbit(layout.scale);
  const std::size_t block = reader.Unsigned(16);
  if (block < 2) return fault("expected the data to begin in block 2 or later");
  layout.data_begin = (block - 1) * kC3dBlock;
  if (layout.analog_per_frame > 0) {
    layout.analog_channels = analog_words / layout.analog_per_frame;
    if (layout.analog_channels * layout.analog_per_frame != analog_words) {
      return fault(std::to_string(analog_words) + " analog values a frame do not divide into " +
                   std::to_string(layout.analog_per_frame) + " samples");
    }
  }
  if (layout.points == 0 && layout.analog_channels == 0) return fault("no points and no channels");
  if (layout.points > kMostColumns || layout.analog_channels > kMostColumns) {
    return fault("more than " + std::to_string(kMostColumns) + " points or channels");
  }
  if (!IsRate(layout.rate_hz)) return fault("expected a frame rate from 0.1 to 100000 Hz");
  if (!layout.floats && !(layout.scale > 0)) return fault("the scale of integer data is 0");
  if (layout.frames == 0) return fault("no frame in the file");
  if (layout.data_begin > file_bytes ||
      layout.frames > (file_bytes - layout.data_begin) / layout.frame_bytes()) {
    return fault(std::to_string(layout.frames) + " frames of " +
                 std::to_string(layout.frame_bytes()) +
                 " bytes are announced: the file ends before");
  }
  return layout;
}

/// A place and whether it was seen: the fourth word is negative where not.
Eigen::Vector3d PointAt(const C3dReader& reader, const Layout& layout, std::size_t at) {
  Eigen::Vector3d p;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t here = at + layout.word() * static_cast<std::size_t>(axis);
    p(axis) = layout.floats ? static_cast<double>(reader.Float(here))
                            : layout.scale * reader.Signed(here);
  }
  const std::size_t fourth = at + 3 * layout.word();
  const double residual =
      layout.floats ? static_cast<double>(reader.Float(fourth)) : reader.Signed(fourth);
  const bool seen = residual >= 0 && p.allFinite() && !p.isZero(0) &&
                    p.lpNorm<Eigen::Infinity>() <= kGreatestValue;
  return seen ? p : Eigen::Vector3d::Constant(kMissing);
}

std::vector<std::string> NamesFor(std::size_t count, std::vector<std::string> labels,
                                  const char* otherwise) {
  labels.resize(std::min(labels.size(), count));
  for (std::size_t i = labels.size(); i < count; ++i) labels.emplace_back();
  for (std::size_t i = 0; i < count; ++i) {
    if (labels[i].empty()) labels[i] = otherwise + std::to_string(i + 1);
  }
  return labels;
}

std::vector<C3dPlate> Plates(const C3dParameters& parameters, double unit_m, std::size_t channels) {
  const auto list = [&parameters](const char* name) {
    const auto found = parameters.numbers.find(name);
    return found == parameters.numbers.end() ? std::vector<double>() : found->second;
  };
  const auto used = std::clamp(parameters.Number("FORCE_PLATFORM:USED", 0), 0.0, 100.0);
  const auto types = list("FORCE_PLATFORM:TYPE"), corners = list("FORCE_PLATFORM:CORNERS");
  const auto origins = list("FORCE_PLATFORM:ORIGIN"), wires = list("FORCE_PLATFORM:CHANNEL");
  std::vector<C3dPlate> plates(static_cast<std::size_t>(used));
  const std::size_t wires_each = plates.empty() ? 0 : wires.size() / plates.size();
  for (std::size_t i = 0; i < plates.size(); ++i) {
    C3dPlate& plate = plates[i];
    if (i < types.size()) plate.type = static_cast<int>(std::clamp(types[i], -1.0, 1000.0));
    for (std::size_t k = 0; k < 12 && 12 * i + k < corners.size(); ++k) {
      plate.corners(static_cast<int>(k % 3), static_cast<int>(k / 3)) =
          unit_m * corners[12 * i + k];
    }
    for (std::size_t k = 0; k < 3 && 3 * i + k < origins.size(); ++k) {
      plate.origin_m(static_cast<int>(k)) = unit_m * origins[3 * i + k];
    }
    for (std::size_t k = 0; k < wires_each; ++k) {
      const double wire = wires[wires_each * i + k];
      if (wire >= 1 && wire < static_cast<double>(channels) + 1) {
        plate.channels.push_back(static_cast<int>(wire) - 1);
      }
    }
  }
  return plates;
}

/// Scales of the analog channels, as many as there are.
struct AnalogScale {
  double general = 1;
  std::vector<double> scale, offset;
  bool is_unsigned = false;

  AnalogScale(const C3dParameters& parameters, std::size_t channels)
      : general(parameters.Number("ANALOG:GEN_SCALE", 1)),
        scale(channels, 1.0),
        offset(channels, 0.0),
        is_unsigned(parameters.Text("ANALOG:FORMAT") == "UNSIGNED") {
    const auto copy = [&](const char* name, std::vector<double>& to) {
      const auto found = parameters.numbers.find(name);
      if (found == parameters.numbers.end()) return;
      std::copy_n(found->second.begin(), std::min(to.size(), found->second.size()), to.begin());
    };
    copy("ANALOG:SCALE", scale);
    copy("ANALOG:OFFSET", offset);
  }
};

/// The data section: of each frame the points, then the samples of all channels.
Result<void> ReadFrames(const C3dReader& reader, const Layout& layout, double unit_m,
                        const AnalogScale& analog, const std::string& file, C3d& c3d) {
  const auto frames = static_cast<Eigen::Index>(layout.frames);
  for (std::size_t i = 0; i < layout.points; ++i) c3d.points.p.emplace_back(3, frames);
  c3d.analog.resize(static_cast<Eigen::Index>(layout.analog_channels),
                    frames * static_cast<Eigen::Index>(layout.analog_per_frame));
  std::size_t at = layout.data_begin;
  for (Eigen::Index frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < layout.points; ++i) {
      c3d.points.p[i].col(frame) = unit_m * PointAt(reader, layout, at);
      at += 4 * layout.word();
    }
    for (std::size_t sample = 0; sample < layout.analog_per_frame; ++sample) {
      const Eigen::Index column = frame * static_cast<Eigen::Index>(layout.analog_per_frame) +
                                  static_cast<Eigen::Index>(sample);
      for (std::size_t channel = 0; channel < layout.analog_channels; ++channel) {
        const double raw = layout.floats        ? static_cast<double>(reader.Float(at))
                           : analog.is_unsigned ? reader.Unsigned(at)
                                                : reader.Signed(at);
        const double value =
            (raw - analog.offset[channel]) * analog.scale[channel] * analog.general;
        if (!(std::abs(value) <= kGreatestValue)) {
          return InvalidData(file + ": channel " + c3d.analog_names[channel] +
                             " has no number within +-1e9 in frame " + std::to_string(frame + 1));
        }
        c3d.analog(static_cast<Eigen::Index>(channel), column) = value;
        at += layout.word();
      }
    }
  }
  return {};
}

}  // namespace

Result<C3d> ParseC3d(std::span<const std::uint8_t> bytes, const std::string& file) {
  const auto fault = [&file](const std::string& what) { return InvalidData(file + ": " + what); };
  if (bytes.size() < 2 * kC3dBlock || bytes[1] != kC3dMark || bytes[0] < 2) {
    return fault("not a C3D file: expected a header of 512 bytes with 0x50 as its second byte");
  }
  const std::size_t section = (std::size_t{bytes[0]} - 1) * kC3dBlock;
  if (section + 4 > bytes.size()) return fault("the parameters lie beyond the end of the file");
  const int number = bytes[section + 3];
  if (number < 84 || number > 86) {
    return fault("expected processor 84, 85 or 86, found " + std::to_string(number));
  }
  const C3dReader reader(bytes, static_cast<Processor>(number));
  const auto parameters = ParseC3dParameters(reader, section, file);
  if (!parameters) return parameters.error();
  const auto layout = ToLayout(reader, *parameters, bytes.size(), file);
  if (!layout) return layout.error();
  const std::string unit = parameters->Text("POINT:UNITS");
  const double unit_m = unit.empty() ? 1e-3 : MetresOf(unit);
  if (unit_m == 0) {
    return fault("expected POINT:UNITS m, cm or mm, found " + text::Quoted(unit));
  }

  C3d c3d;
  c3d.x_screen = parameters->Text("POINT:X_SCREEN");
  c3d.y_screen = parameters->Text("POINT:Y_SCREEN");
  c3d.points.rate_hz = layout->rate_hz;
  c3d.points.names = NamesFor(layout->points, parameters->Labels("POINT"), "point ");
  c3d.analog_names = NamesFor(layout->analog_channels, parameters->Labels("ANALOG"), "channel ");
  const auto units = parameters->texts.find("ANALOG:UNITS");
  if (units != parameters->texts.end()) c3d.analog_units = units->second;
  c3d.analog_units.resize(layout->analog_channels);
  c3d.analog_rate_hz = layout->rate_hz * static_cast<double>(layout->analog_per_frame);
  c3d.plates = Plates(*parameters, unit_m, layout->analog_channels);
  const AnalogScale analog(*parameters, layout->analog_channels);
  if (auto read = ReadFrames(reader, *layout, unit_m, analog, file, c3d); !read) {
    return read.error();
  }
  return c3d;
}

namespace {

constexpr double kLeastForceN = 10;  // Below, the centre of pressure says nothing.

/// Axes of a plate in those of the file: x from corners 2 and 3 to 1 and 4, z down into the floor.
Eigen::Matrix3d Axes(const Eigen::Matrix<double, 3, 4>& corners) {
  const Eigen::Vector3d x = (corners.col(0) + corners.col(3) - corners.col(1) - corners.col(2));
  const Eigen::Vector3d y = (corners.col(0) + corners.col(1) - corners.col(2) - corners.col(3));
  Eigen::Matrix3d axes;
  axes.col(0) = x.normalized();
  axes.col(2) = x.cross(y).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// "Nm", "N.m", "N*m", "NM", not "Nmm".
bool IsNewtonMetre(const std::string& unit) {
  std::string letters;
  std::copy_if(unit.begin(), unit.end(), std::back_inserter(letters),
               [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
  return text::EqualsIgnoringCase(letters, "nm");
}

}  // namespace

Result<GroundForces> ToGroundForces(const C3d& c3d, const std::string& file) {
  GroundForces forces;
  forces.rate_hz = c3d.analog_rate_hz;
  for (std::size_t i = 0; i < c3d.plates.size(); ++i) {
    const C3dPlate& plate = c3d.plates[i];
    const std::string name = "plate " + std::to_string(i + 1);
    if (plate.type != 2 && plate.type != 4) {
      return InvalidData(file + ": " + name + " is of type " + std::to_string(plate.type) +
                         "; only types 2 and 4 are understood");
    }
    if (plate.channels.size() != 6) {
      return InvalidData(file + ": " + name + " needs six channels, has " +
                         std::to_string(plate.channels.size()));
    }
    const Eigen::Matrix3d R = Axes(plate.corners);
    if (!R.allFinite() || std::abs(R.determinant() - 1) > 1e-6) {
      return InvalidData(file + ": the corners of " + name + " do not form a rectangle");
    }
    const Eigen::Vector3d middle = plate.corners.rowwise().mean();
    // The surface is over the origin and z points down, whatever sign the file has.
    Eigen::Vector3d to_surface = plate.origin_m;
    to_surface.z() = -std::abs(to_surface.z());
    const auto channel = [&](std::size_t k) { return c3d.analog.row(plate.channels[k]); };
    // Moments come in the unit of the points, mostly N mm.
    const std::string& unit = c3d.analog_units[static_cast<std::size_t>(plate.channels[3])];
    const double moment_scale = IsNewtonMetre(unit) ? 1 : 1e-3;
    // Some laboratories store the force on the plate, some that on the person. A plate is only ever
    // pressed down, and its z points down: on the person the sum is negative.
    const double sign = channel(2).sum() > 0 ? -1 : 1;
    PlateForces out;
    out.name = name;
    const Eigen::Index samples = c3d.analog.cols();
    out.force_W.resize(3, samples);
    out.cop_W.setZero(3, samples);
    out.moment_W.setZero(3, samples);
    for (Eigen::Index s = 0; s < samples; ++s) {
      const Eigen::Vector3d force(channel(0)(s), channel(1)(s), channel(2)(s));
      const Eigen::Vector3d moment =
          moment_scale * Eigen::Vector3d(channel(3)(s), channel(4)(s), channel(5)(s));
      out.force_W.col(s) = sign * (R * force);
      if (std::abs(force.z()) < kLeastForceN) continue;
      const Eigen::Vector3d about = moment - to_surface.cross(force);
      const Eigen::Vector3d cop(-about.y() / force.z(), about.x() / force.z(), 0);
      out.cop_W.col(s) = middle + R * cop;
      out.moment_W.col(s) = sign * (R * (about - cop.cross(force)));
    }
    forces.plates.push_back(std::move(out));
  }
  return forces;
}

namespace {

constexpr std::size_t kLongestText = 127;
constexpr std::size_t kLongestList = 255;  // Length of one dimension of a parameter.
constexpr std::size_t kMostInAWord = 0xFFFF;
constexpr double kMillimetres = 1000;  // Millimetres.
constexpr double kScale = -1;          // Negative: the data are floats.

void AppendWord(std::size_t value, std::string& out) {
  out += static_cast<char>(value & 0xFF);
  out += static_cast<char>(value >> 8 & 0xFF);
}

void AppendFloat(double value, std::string& out) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  AppendWord(bits & 0xFFFF, out);
  AppendWord(bits >> 16, out);
}

void PadToBlock(std::string& out) {
  out.resize((out.size() + kC3dBlock - 1) / kC3dBlock * kC3dBlock);
}

/// The entries of a parameter section, group after group.
class Parameters {
 public:
  void Group(const std::string& name) {
    ++group_;
    Entry(name, -group_, "");
  }
  void Integers(const std::string& name, const std::vector<std::size_t>& dimensions,
                const std::vector<std::size_t>& values) {
    std::string data = Shape(2, dimensions);
    for (const std::size_t value : values) AppendWord(value, data);
    Entry(name, group_, data);
  }
  void Integer(const std::string& name, std::size_t value) { Integers(name, {}, {value}); }
  void Floats(const std::string& name, const std::vector<std::size_t>& dimensions,
              const std::vector<double>& values) {
    std::string data = Shape(4, dimensions);
    for (const double value : values) AppendFloat(value, data);
    Entry(name, group_, data);
  }
  void Text(const std::string& name, std::string_view text) {
    Entry(name, group_, Shape(-1, {text.size()}) + std::string(text));
  }
  /// Further texts than fit one parameter go into NAME2, NAME3, ...
  void Texts(const std::string& name, const std::vector<std::string>& texts) {
    for (std::size_t first = 0, part = 1; first < texts.size(); first += kLongestList, ++part) {
      const std::size_t count = std::min(kLongestList, texts.size() - first);
      std::size_t width = 1;
      for (std::size_t i = 0; i < count; ++i) width = std::max(width, texts[first + i].size());
      std::string data = Shape(-1, {std::min(width, kLongestText), count});
      for (std::size_t i = 0; i < count; ++i) {
        std::string text = texts[first + i];
        text.resize(std::min(width, kLongestText), ' ');
        data += text;
      }
      Entry(name + (part == 1 ? "" : std::to_string(part)), group_, data);
    }
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::string Shape(int type, const std::vector<std::size_t>& dimensions) {
    std::string shape = {static_cast<char>(type), static_cast<char>(dimensions.size())};
    for (const std::size_t length : dimensions) shape += static_cast<char>(length);
    return shape;
  }
  void Entry(const std::string& name, int id, const std::string& data) {
    bytes_ += static_cast<char>(name.size());
    bytes_ += static_cast<char>(id);
    bytes_ += name;
    AppendWord(2 + data.size() + 1, bytes_);  // From this word to the next entry.
    bytes_ += data;
    bytes_ += '\0';  // No description.
  }

  int group_ = 0;
  std::string bytes_;
};

void AddPoints(const C3d& c3d, std::size_t data_block, Parameters& to) {
  const auto frames = static_cast<std::size_t>(c3d.points.frames());
  to.Group("POINT");
  to.Integer("USED", c3d.points.p.size());
  to.Floats("SCALE", {}, {kScale});
  to.Floats("RATE", {}, {c3d.points.rate_hz});
  to.Integer("DATA_START", data_block);
  to.Integer("FRAMES", std::min(frames, kMostInAWord));
  to.Texts("LABELS", c3d.points.names);
  to.Texts("DESCRIPTIONS", std::vector<std::string>(c3d.points.names.size()));
  to.Text("UNITS", "mm");
  if (!c3d.x_screen.empty()) to.Text("X_SCREEN", c3d.x_screen);
  if (!c3d.y_screen.empty()) to.Text("Y_SCREEN", c3d.y_screen);
  // More frames than a word counts: low and high word of the first and the last frame's number.
  to.Group("TRIAL");
  to.Integers("ACTUAL_START_FIELD", {2}, {1, 0});
  to.Integers("ACTUAL_END_FIELD", {2}, {frames & kMostInAWord, frames >> 16});
  to.Floats("CAMERA_RATE", {}, {c3d.points.rate_hz});
}

void AddAnalog(const C3d& c3d, Parameters& to) {
  const std::size_t channels = c3d.analog_names.size();
  to.Group("ANALOG");
  to.Integer("USED", channels);
  to.Floats("RATE", {}, {c3d.analog_rate_hz});
  to.Floats("GEN_SCALE", {}, {1});
  if (channels == 0) return;
  to.Floats("SCALE", {channels}, std::vector<double>(channels, 1));
  to.Integers("OFFSET", {channels}, std::vector<std::size_t>(channels, 0));
  to.Texts("LABELS", c3d.analog_names);
  to.Texts("DESCRIPTIONS", std::vector<std::string>(channels));
  to.Texts("UNITS", c3d.analog_units);
}

void AddPlates(const C3d& c3d, Parameters& to) {
  const std::size_t count = c3d.plates.size();
  std::vector<double> corners, origins;
  std::vector<std::size_t> types, channels;
  for (const C3dPlate& plate : c3d.plates) {
    types.push_back(static_cast<std::size_t>(plate.type));
    for (const double value : plate.corners.reshaped()) corners.push_back(kMillimetres * value);
    for (const double value : plate.origin_m) origins.push_back(kMillimetres * value);
    for (const int channel : plate.channels) {
      channels.push_back(static_cast<std::size_t>(channel) + 1);
    }
  }
  to.Group("FORCE_PLATFORM");
  to.Integer("USED", count);
  if (count == 0) return;
  to.Integers("TYPE", {count}, types);
  to.Integers("ZERO", {2}, {0, 0});  // No frames without a load to subtract.
  to.Floats("CORNERS", {3, 4, count}, corners);
  to.Floats("ORIGIN", {3, count}, origins);
  to.Integers("CHANNEL", {channels.size() / count, count}, channels);
}

/// The parameter section, whole blocks.
std::string ParameterSection(const C3d& c3d, std::size_t data_block) {
  Parameters parameters;
  AddPoints(c3d, data_block, parameters);
  AddAnalog(c3d, parameters);
  AddPlates(c3d, parameters);
  std::string section = {1, kC3dMark, 0, static_cast<char>(Processor::kIntel)};
  section += parameters.bytes() + std::string(2, '\0');  // The end mark.
  PadToBlock(section);
  section[2] = static_cast<char>(section.size() / kC3dBlock);
  return section;
}

std::string HeaderBlock(const C3d& c3d, std::size_t samples_per_frame, std::size_t data_block) {
  std::string header = {2, kC3dMark};
  AppendWord(c3d.points.p.size(), header);
  AppendWord(samples_per_frame * c3d.analog_names.size(), header);
  AppendWord(1, header);
  AppendWord(std::min(static_cast<std::size_t>(c3d.points.frames()), kMostInAWord), header);
  AppendWord(0, header);  // The longest gap that was filled.
  AppendFloat(kScale, header);
  AppendWord(data_block, header);
  AppendWord(samples_per_frame, header);
  AppendFloat(c3d.points.rate_hz, header);
  PadToBlock(header);
  return header;
}

Result<void> CheckSizes(const C3d& c3d) {
  const auto frames = static_cast<std::size_t>(c3d.points.frames());
  const auto samples = static_cast<std::size_t>(c3d.analog.cols());
  if (frames == 0) return InvalidData("a C3D file needs a point and a frame");
  if (c3d.points.p.size() > kMostColumns || c3d.analog_names.size() > kLongestList) {
    return InvalidData("a C3D file is written with at most " + std::to_string(kMostColumns) +
                       " points and " + std::to_string(kLongestList) + " analog channels");
  }
  const bool fits = c3d.analog_names.empty() || (samples > 0 && samples % frames == 0);
  if (!fits) return InvalidData("the analog samples do not divide into the frames");
  return {};
}

}  // namespace

Result<std::string> WriteC3d(const C3d& c3d) {
  if (const auto fits = CheckSizes(c3d); !fits) return fits.error();
  const std::size_t sections = ParameterSection(c3d, 0).size() / kC3dBlock;
  if (sections > kLongestList) return InvalidData("the names of points take too much place");
  const std::size_t data_block = 2 + sections;
  const Eigen::Index per_frame = c3d.analog.cols() / c3d.points.frames();
  std::string out = HeaderBlock(c3d, static_cast<std::size_t>(per_frame), data_block);
  out += ParameterSection(c3d, data_block);
  for (Eigen::Index frame = 0; frame < c3d.points.frames(); ++frame) {
    for (const Eigen::Matrix3Xd& point : c3d.points.p) {
      const bool seen = Seen(point.col(frame));
      for (const double value : point.col(frame)) AppendFloat(seen ? kMillimetres * value : 0, out);
      AppendFloat(seen ? 0 : -1, out);
    }
    for (Eigen::Index sample = 0; sample < per_frame; ++sample) {
      for (const double value : c3d.analog.col(frame * per_frame + sample)) {
        AppendFloat(value, out);
      }
    }
  }
  PadToBlock(out);
  return out;
}

namespace {

using body::Joint;
using body::Landmark;

constexpr double kStraight = 1e-3;  // Sine of an angle that counts as none.

/// A thigh of three angles, a shank of one that hangs on it, and the foot.
class Leg {
 public:
  Leg(const body::Skeleton& skeleton, const body::Landmarks& landmarks, int side)
      : hip_(&skeleton.joint(landmarks[body::OfSide(Landmark::kLeftHip, side)])),
        knee_index_(landmarks[body::OfSide(Landmark::kLeftKnee, side)]),
        knee_(&skeleton.joint(knee_index_)),
        ankle_(&skeleton.joint(landmarks[body::OfSide(Landmark::kLeftAnkle, side)])),
        along_(knee_->offset_m.normalized()),
        half_(Eigen::AngleAxisd(kPi, along_)) {}

  /// The ankle hangs on the knee, which hangs on the hip, in one line with both at rest and across
  /// the hinge: else the other solution has the ankle elsewhere.
  bool HasHinge(const body::Landmarks& landmarks, int side) const {
    if (hip_->rotations.size() != 3 || knee_->rotations.size() != 1 ||
        knee_->parent != landmarks[body::OfSide(Landmark::kLeftHip, side)] ||
        ankle_->parent != knee_index_ || !(knee_->offset_m.norm() > 0)) {
      return false;
    }
    const Eigen::Vector3d hinge = knee_->axes.col(static_cast<int>(knee_->rotations[0].axis));
    return ankle_->offset_m.normalized().cross(along_).norm() < kStraight &&
           std::abs(hinge.dot(along_)) < kStraight;
  }

  /// Takes the solution of `q` that is nearer to `before`.
  void Choose(const Eigen::VectorXd& before, Eigen::Ref<Eigen::VectorXd> q) const {
    const Eigen::Matrix3d was = JointRotation(*hip_, before), is = JointRotation(*hip_, q);
    const Eigen::Matrix3d turned = is * half_;
    if ((was.transpose() * is).trace() >= (was.transpose() * turned).trace()) return;
    const Eigen::Matrix3d foot = is * JointRotation(*knee_, q) * JointRotation(*ankle_, q);
    SetJointRotation(*hip_, turned, q);
    q(knee_->first_dof) = NearestTurn(-q(knee_->first_dof), before(knee_->first_dof));
    const Eigen::Matrix3d shank = turned * JointRotation(*knee_, q);
    const auto turns = static_cast<int>(ankle_->rotations.size());
    q.segment(ankle_->first_dof, turns) = before.segment(ankle_->first_dof, turns);
    SetJointRotation(*ankle_, shank.transpose() * foot, q);
  }

 private:
  const Joint* hip_;
  int knee_index_;
  const Joint* knee_;
  const Joint* ankle_;
  Eigen::Vector3d along_;  ///< The thigh, in its frame.
  Eigen::Matrix3d half_;   ///< Half a turn about it.
};

}  // namespace

Motion WithoutHalfTurns(Motion motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return motion;
  for (int side = 0; side < 2; ++side) {
    const Leg leg(motion.skeleton, *landmarks, side);
    if (!leg.HasHinge(*landmarks, side)) continue;
    for (Eigen::Index frame = 1; frame < motion.frames(); ++frame) {
      leg.Choose(motion.q.col(frame - 1), motion.q.col(frame));
    }
  }
  return motion;
}

namespace {

constexpr std::size_t kMostEntries = 10'000;

std::string Upper(const C3dReader& reader, std::size_t at, std::size_t length) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i) {
    text += static_cast<char>(std::toupper(reader.Byte(at + i)));
  }
  return text;
}

struct Values {
  std::vector<double> numbers;
  std::vector<std::string> texts;
};

/// Type, dimensions and values of one parameter, from byte `at` on.
bool ParseValues(const C3dReader& reader, std::size_t at, Values& out) {
  if (!reader.Has(at, 2)) return false;
  const int type = static_cast<std::int8_t>(reader.Byte(at));
  const std::size_t dimensions = reader.Byte(at + 1);
  const std::size_t size = static_cast<std::size_t>(std::abs(type));
  if ((type != -1 && type != 1 && type != 2 && type != 4) || dimensions > 7) return false;
  at += 2;
  if (!reader.Has(at, dimensions)) return false;
  std::size_t count = 1, width = 1;
  for (std::size_t i = 0; i < dimensions; ++i) {
    const std::size_t length = reader.Byte(at + i);
    if (i == 0) width = length;
    count *= length;
    if (count > 1u << 20) return false;
  }
  at += dimensions;
  if (!reader.Has(at, count * size)) return false;
  if (type == -1) {
    if (dimensions == 0) width = 1;
    for (std::size_t i = 0; width > 0 && i + width <= count; i += width) {
      std::string text;
      for (std::size_t k = 0; k < width; ++k) text += static_cast<char>(reader.Byte(at + i + k));
      text.resize(std::min(text.size(), text.find('\0')));
      out.texts.emplace_back(text::Trim(text));
    }
    return true;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t here = at + i * size;
    const double value = type == 4   ? static_cast<double>(reader.Float(here))
                         : type == 2 ? reader.Signed(here)
                                     : reader.Byte(here);
    out.numbers.push_back(std::isfinite(value) ? value : 0);
  }
  return true;
}

}  // namespace

double C3dParameters::Number(const std::string& name, double otherwise) const {
  const auto found = numbers.find(name);
  return found == numbers.end() || found->second.empty() ? otherwise : found->second[0];
}

std::string C3dParameters::Text(const std::string& name) const {
  const auto found = texts.find(name);
  return found == texts.end() || found->second.empty() ? "" : found->second[0];
}

std::vector<std::string> C3dParameters::Labels(const std::string& group) const {
  std::vector<std::string> labels;
  for (int part = 1; part < 100; ++part) {
    const auto found = texts.find(group + ":LABELS" + (part == 1 ? "" : std::to_string(part)));
    if (found == texts.end()) break;
    labels.insert(labels.end(), found->second.begin(), found->second.end());
  }
  return labels;
}

Result<C3dParameters> ParseC3dParameters(const C3dReader& reader, std::size_t begin,
                                         const std::string& file) {
  // Names of groups may come after their parameters.
  std::map<int, std::string> groups;
  std::vector<std::pair<std::pair<int, std::string>, Values>> found;
  std::size_t at = begin + 4;
  for (std::size_t entry = 0;; ++entry) {
    const auto fault = [&](const std::string& what) {
      return InvalidData(file + ", byte " + std::to_string(at) + ": " + what);
    };
    if (entry > kMostEntries) return fault("more than 10000 parameters");
    if (!reader.Has(at, 2)) return fault("the parameters end before their end mark");
    const auto length = static_cast<std::size_t>(
        std::abs(static_cast<int>(static_cast<std::int8_t>(reader.Byte(at)))));
    const int group = static_cast<std::int8_t>(reader.Byte(at + 1));
    if (length == 0 || group == 0) break;
    if (!reader.Has(at + 2, length + 2)) return fault("a parameter is cut off");
    std::string name = Upper(reader, at + 2, length);
    const std::size_t link = at + 2 + length;
    const std::size_t next = reader.Unsigned(link);
    if (group < 0) {
      groups[-group] = std::move(name);
    } else {
      Values values;
      if (!ParseValues(reader, link + 2, values)) {
        return fault("parameter " + text::Quoted(name) + " is of no known type or size");
      }
      found.push_back({{group, std::move(name)}, std::move(values)});
    }
    if (next == 0) break;
    at = link + next;
  }
  C3dParameters parameters;
  for (auto& [key, values] : found) {
    const std::string name = groups[key.first] + ":" + key.second;
    if (!values.texts.empty()) parameters.texts[name] = std::move(values.texts);
    if (!values.numbers.empty()) parameters.numbers[name] = std::move(values.numbers);
  }
  return parameters;
}

}  // namespace footing::motion
