#include "common/virtual/motion/c3d.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/virtual/motion/c3d_parameters.h"
#include "common/virtual/motion/c3d_reader.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/rate.h"
#include "common/virtual/motion/value.h"

namespace footing::motion {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// What the header block and the parameters say about the data.
struct Layout {
  std::size_t points = 0, frames = 0;
  std::size_t analog_channels = 0, analog_per_frame = 0;
  double scale = 0;  ///< Of integers; floats need none.
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

double UnitOf(const std::string& text) {
  if (text == "m") return 1;
  if (text == "cm") return 1e-2;
  return text == "mm" || text.empty() ? 1e-3 : 0;
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
  const double unit_m = UnitOf(parameters->Text("POINT:UNITS"));
  if (unit_m == 0) return fault("expected POINT:UNITS m, cm or mm");

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

}  // namespace footing::motion
