#include "common/virtual/motion/bvh.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "common/body/y_up.h"
#include "common/base/lines.h"
#include "common/base/number.h"
#include "common/base/units.h"
#include "common/virtual/motion/bvh_stem.h"
#include "common/virtual/motion/rate.h"
#include "common/virtual/motion/value.h"

namespace footing::motion {
namespace {

using body::Axis;
using body::Joint;

/// A joint's position channels may differ from where it begins by as much.
constexpr double kStillM = 0.001;

/// One number of a frame: what it is and where it goes.
struct Channel {
  int joint = 0;
  bool rotation = false;
  Axis axis = Axis::kX;  ///< Of the file.
  int dof = -1;          ///< Into q; -1 for the position of a joint that is not the root.
  int stem_row = -1;     ///< Of such a position, into those of the stem (bvh_stem.h).
};

struct Header {
  std::vector<Joint> joints;
  std::vector<Channel> channels;
};

/// Words of the header, however they are spread over lines.
class HeaderTokens {
 public:
  explicit HeaderTokens(text::Lines& lines) : lines_(lines) {}

  std::string_view Next() {
    for (;;) {
      const std::string_view word = text::TakeWord(line_);
      if (!word.empty()) return word;
      const auto line = lines_.Next();
      if (!line) return {};
      line_ = *line;
    }
  }
  /// What is left of the line, but for a brace at its end: a name with blanks.
  std::string_view Name() {
    std::string_view name = text::Trim(line_);
    line_ = {};
    if (!name.empty() && name.back() == '{') {
      line_ = "{";
      name = text::Trim(name.substr(0, name.size() - 1));
    }
    return name;
  }
  Error Expected(const std::string& what, std::string_view found) const {
    return lines_.Fault("expected " + what + ", found " +
                        (found.empty() ? "the end of the file" : text::Quoted(found)));
  }
  text::Lines& lines() { return lines_; }

 private:
  text::Lines& lines_;
  std::string_view line_;
};

std::optional<Channel> ToChannel(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, bool>, 2> kKinds = {
      {{"position", false}, {"rotation", true}}};
  if (word.empty()) return std::nullopt;
  const char axis = word[0];
  const int index = axis == 'X' || axis == 'x'   ? 0
                    : axis == 'Y' || axis == 'y' ? 1
                    : axis == 'Z' || axis == 'z' ? 2
                                                 : -1;
  for (const auto& [name, rotation] : kKinds) {
    if (index >= 0 && text::EqualsIgnoringCase(word.substr(1), name)) {
      Channel channel;
      channel.rotation = rotation;
      channel.axis = static_cast<Axis>(index);
      return channel;
    }
  }
  return std::nullopt;
}

Result<void> ParseOffset(HeaderTokens& words, double unit_m, Joint& joint) {
  Eigen::Vector3d offset;
  for (int axis = 0; axis < 3; ++axis) {
    const auto word = words.Next();
    const auto number = ToValue(word);
    if (!number) return words.Expected("a number of OFFSET within +-1e9", word);
    offset(axis) = *number * unit_m;
  }
  joint.offset_m = body::FromYUp(offset);
  return {};
}

Result<void> ParseChannels(HeaderTokens& words, int joint, Header& header) {
  const auto count_word = words.Next();
  const auto count = text::ToCount(count_word);
  if (!count || *count > 6) return words.Expected("a number of channels up to 6", count_word);
  std::array<bool, 6> seen{};
  for (std::size_t i = 0; i < *count; ++i) {
    const auto word = words.Next();
    auto channel = ToChannel(word);
    if (!channel) return words.Expected("a channel such as Xposition or Zrotation", word);
    bool& before = seen[static_cast<std::size_t>(channel->axis) + (channel->rotation ? 3u : 0u)];
    if (std::exchange(before, true))
      return words.lines().Fault(std::string(word) + " stands twice");
    channel->joint = joint;
    if (channel->rotation) {
      header.joints[static_cast<std::size_t>(joint)].rotations.push_back(
          {body::FromYUp(channel->axis), -body::kUnlimited, body::kUnlimited});
    }
    header.channels.push_back(*channel);
  }
  return {};
}

Result<Header> ParseHeader(HeaderTokens& words, double unit_m) {
  auto word = words.Next();
  if (!text::EqualsIgnoringCase(word, "HIERARCHY")) return words.Expected("HIERARCHY", word);
  Header header;
  std::vector<int> open;
  do {
    word = words.Next();
    const bool root = text::EqualsIgnoringCase(word, "ROOT"),
               end = text::EqualsIgnoringCase(word, "End");
    if (root || end || text::EqualsIgnoringCase(word, "JOINT")) {
      if (root != open.empty()) {
        return words.lines().Fault(root ? "a second ROOT: one skeleton a file" : "no ROOT before");
      }
      if (header.joints.size() >= kMostJoints || open.size() >= kMostDepth) {
        return words.lines().Fault("more than " + std::to_string(kMostJoints) + " joints or " +
                                   std::to_string(kMostDepth) + " levels");
      }
      Joint joint;
      joint.parent = open.empty() ? -1 : open.back();
      const auto name = words.Name();
      if (end) {
        const auto of = header.joints[static_cast<std::size_t>(joint.parent)].name;
        joint.name = of + "_end";
      } else {
        if (name.empty()) return words.lines().Fault("a joint without a name");
        joint.name = std::string(name);
      }
      open.push_back(static_cast<int>(header.joints.size()));
      header.joints.push_back(std::move(joint));
      word = words.Next();
      if (word != "{") return words.Expected("'{'", word);
    } else if (text::EqualsIgnoringCase(word, "OFFSET") && !open.empty()) {
      const auto done =
          ParseOffset(words, unit_m, header.joints[static_cast<std::size_t>(open.back())]);
      if (!done) return done.error();
    } else if (text::EqualsIgnoringCase(word, "CHANNELS") && !open.empty()) {
      if (!header.joints[static_cast<std::size_t>(open.back())].rotations.empty()) {
        return words.lines().Fault("a second CHANNELS of one joint");
      }
      const auto done = ParseChannels(words, open.back(), header);
      if (!done) return done.error();
    } else if (word == "}" && !open.empty()) {
      open.pop_back();
    } else {
      return words.Expected(open.empty() ? "ROOT" : "JOINT, End Site, OFFSET, CHANNELS or }", word);
    }
  } while (!open.empty());
  return header;
}

/// Where each channel goes; the skeleton's own order of coordinates is the joints'.
Result<body::Skeleton> Place(Header& header, text::Lines& lines) {
  body::Skeleton skeleton = body::MakeSkeleton(header.joints);
  std::vector<int> next;
  const int stem = StemLength(skeleton);
  int positions = 0;
  for (const Joint& joint : skeleton.joints) next.push_back(joint.first_dof);
  for (Channel& channel : header.channels) {
    if (channel.rotation) {
      channel.dof = next[static_cast<std::size_t>(channel.joint)]++;
    } else if (channel.joint == 0) {
      channel.dof = static_cast<int>(body::FromYUp(channel.axis));
      ++positions;
    } else if (channel.joint <= stem) {
      channel.stem_row = 3 * (channel.joint - 1) + static_cast<int>(body::FromYUp(channel.axis));
    }
  }
  if (positions != 3) return lines.Fault("the root needs Xposition, Yposition and Zposition");
  return skeleton;
}

Result<std::pair<std::size_t, double>> ParseMotionHead(HeaderTokens& words) {
  auto word = words.Next();
  if (!text::EqualsIgnoringCase(word, "MOTION")) return words.Expected("MOTION", word);
  word = words.Next();
  if (!text::EqualsIgnoringCase(word, "Frames:")) return words.Expected("'Frames:'", word);
  word = words.Next();
  const auto frames = text::ToCount(word);
  if (!frames || *frames == 0) return words.Expected("a number of frames over 0", word);
  word = words.Next();
  if (!text::EqualsIgnoringCase(word, "Frame")) return words.Expected("'Frame Time:'", word);
  word = words.Next();
  if (!text::EqualsIgnoringCase(word, "Time:")) return words.Expected("'Frame Time:'", word);
  word = words.Next();
  const auto step_s = text::ToNumber(word);
  if (!step_s || !IsRate(1 / *step_s)) {
    return words.Expected("a frame time from 0.00001 to 10 s", word);
  }
  return std::pair{*frames, RateOfStep(*step_s)};
}

/// Where the joints of the stem are, in every frame, unless their position channels say otherwise.
Eigen::MatrixXd PlacesOfStem(const body::Skeleton& skeleton, Eigen::Index frames) {
  Eigen::MatrixXd stem_m(3 * StemLength(skeleton), frames);
  for (Eigen::Index row = 0; row < stem_m.rows(); row += 3) {
    stem_m.middleRows<3>(row).colwise() = skeleton.joint(static_cast<int>(row / 3) + 1).offset_m;
  }
  return stem_m;
}

/// Moves the joint to where its position channels say, or holds it to that.
Result<void> Hold(const Channel& channel, double value_m, bool first, const text::Lines& lines,
                  body::Skeleton& skeleton) {
  double& offset_m = skeleton.joints[static_cast<std::size_t>(channel.joint)].offset_m(
      static_cast<int>(body::FromYUp(channel.axis)));
  if (first) offset_m = value_m;
  if (std::abs(offset_m - value_m) <= kStillM) return {};
  return lines.Fault("joint " + skeleton.joint(channel.joint).name +
                     " moves on its parent: only the root and the joints between it and the hips "
                     "may; bake its motion into rotations");
}

}  // namespace

Result<Motion> ParseBvh(std::string_view text, const std::string& file, const BvhOptions& options) {
  text::Lines lines(text, file);
  HeaderTokens words(lines);
  auto header = ParseHeader(words, options.unit_m);
  if (!header) return header.error();
  auto skeleton = Place(*header, lines);
  if (!skeleton) return skeleton.error();
  const auto head = ParseMotionHead(words);
  if (!head) return head.error();
  const auto [frames, rate_hz] = *head;
  const std::size_t columns = header->channels.size();
  const std::size_t values = columns + 3 * static_cast<std::size_t>(StemLength(*skeleton));
  // A number and the blank after it take two bytes at least.
  if (frames > lines.bytes_left() / 2 / columns + 1 || frames > kMostValues / values) {
    return lines.Fault(std::to_string(frames) + " frames of " + std::to_string(columns) +
                       " channels are announced: the file is too short for that, or over " +
                       std::to_string(kMostValues) + " values");
  }
  Motion motion{std::move(*skeleton), rate_hz, 0, {}};
  motion.q.resize(motion.skeleton.dof, static_cast<Eigen::Index>(frames));
  Eigen::MatrixXd stem_m = PlacesOfStem(motion.skeleton, motion.q.cols());
  for (Eigen::Index frame = 0; frame < motion.q.cols(); ++frame) {
    auto line = lines.NextFull();
    if (!line) {
      return lines.Fault(std::to_string(frames) + " frames are announced, the file ends after " +
                         std::to_string(frame));
    }
    for (std::size_t i = 0; i < columns; ++i) {
      const Channel& channel = header->channels[i];
      const auto word = text::TakeWord(*line);
      const auto number = ToValue(word);
      if (!number) {
        return lines.Fault("frame " + std::to_string(frame + 1) + ": expected number " +
                           std::to_string(i + 1) + " of " + std::to_string(columns) +
                           " within +-1e9, found " +
                           (word.empty() ? "the end of the line" : text::Quoted(word)));
      }
      const double value = channel.rotation ? DegreesToRadians(*number) : *number * options.unit_m;
      if (channel.dof >= 0) {
        motion.q(channel.dof, frame) = value;
      } else if (channel.stem_row >= 0) {
        stem_m(channel.stem_row, frame) = value;
      } else {
        const auto held = Hold(channel, value, frame == 0, lines, motion.skeleton);
        if (!held) return held.error();
      }
    }
    if (!text::Trim(*line).empty()) {
      return lines.Fault("frame " + std::to_string(frame + 1) + " has more than the " +
                         std::to_string(columns) + " numbers of its channels");
    }
  }
  if (lines.NextFull())
    return lines.Fault("more frames than the " + std::to_string(frames) + " announced");
  return OnMovingJoint(std::move(motion), stem_m, kStillM);
}

}  // namespace footing::motion
