#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/virtual/motion/c3d.h"
#include "common/virtual/motion/c3d_reader.h"
#include "common/virtual/motion/motion.h"

namespace footing::motion {
namespace {

constexpr std::size_t kLongestText = 127;
constexpr std::size_t kLongestList = 255;  // Of one dimension of a parameter.
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

}  // namespace footing::motion
