#include "common/virtual/motion/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/skeleton.h"
#include "common/virtual/motion/table.h"

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
  Axis axis = Axis::kX;  ///< Axis in the file.
  int dof = -1;          ///< Into q; -1 for the position of a joint that is not the root.
  int stem_row = -1;     ///< Row of such a position in those of the stem.
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
      const std::string_view word = text::PopWord(line_);
      if (!word.empty()) return word;
      const auto line = lines_.Next();
      if (!line) return {};
      line_ = *line;
    }
  }
  /// Rest of the line, but for a brace at its end: a name with blanks.
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
      const auto word = text::PopWord(*line);
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

namespace {

constexpr int kDecimals = 6;  // For centimetres and degrees: finer than any capture, and stable.

/// A joint as the file can hold it: three rotations about the plain axes.
struct Written {
  Joint joint;
  bool as_it_is = false;
};

Written ToWritten(const Joint& joint) {
  Written written{joint, joint.plain_axes && joint.rotations.size() == 3};
  if (!written.as_it_is) {
    written.joint.axes.setIdentity();
    written.joint.plain_axes = true;
    written.joint.first_dof = 0;
    written.joint.rotations = {{Axis::kX}, {Axis::kZ}, {Axis::kY}};  // Z Y X of the file.
  }
  return written;
}

void AppendVector(std::string& text, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d file = 100 * body::ToYUp(p_W);
  for (int axis = 0; axis < 3; ++axis) {
    text += ' ';
    text::AppendFixed(text, file(axis), kDecimals);
  }
}

class Writer {
 public:
  explicit Writer(const Motion& motion) : skeleton_(motion.skeleton) {
    children_.resize(skeleton_.joints.size());
    for (int i = 1; i < skeleton_.size(); ++i) {
      children_[static_cast<std::size_t>(skeleton_.joint(i).parent)].push_back(i);
    }
    AppendJoint(0, 0);
  }

  std::string text = "HIERARCHY\n";
  std::vector<int> order;  ///< Joints that turn, as the file has them.

 private:
  void AppendJoint(int index, std::size_t depth) {
    const Joint& joint = skeleton_.joint(index);
    const std::string indent(depth, '\t');
    const bool end = body::IsEnd(skeleton_, index);
    text += indent + (index == 0 ? "ROOT " + joint.name
                      : end      ? std::string("End Site")
                                 : "JOINT " + joint.name);
    text += "\n" + indent + "{\n" + indent + "\tOFFSET";
    AppendVector(text, joint.offset_m);
    text += "\n";
    if (!end) {
      order.push_back(index);
      text += indent + "\tCHANNELS " + (index == 0 ? "6 Xposition Yposition Zposition" : "3");
      for (const auto& rotation : ToWritten(joint).joint.rotations) {
        text += ' ';
        text += "XYZ"[static_cast<int>(body::ToYUp(rotation.axis))];
        text += "rotation";
      }
      text += "\n";
      const auto& children = children_[static_cast<std::size_t>(index)];
      for (int child : children) AppendJoint(child, depth + 1);
      if (children.empty()) {
        text += indent + "\tEnd Site\n" + indent + "\t{\n" + indent + "\t\tOFFSET 0.000000 " +
                "0.000000 0.000000\n" + indent + "\t}\n";
      }
    }
    text += indent + "}\n";
  }

  const body::Skeleton& skeleton_;
  std::vector<std::vector<int>> children_;
};

}  // namespace

std::string WriteBvh(const Motion& motion) {
  Writer writer(motion);
  std::string text = std::move(writer.text);
  text += "MOTION\nFrames: " + std::to_string(motion.frames()) + "\nFrame Time: ";
  text::AppendFixed(text, 1 / motion.rate_hz, 9);
  text += "\n";
  std::vector<Written> joints;
  for (const int index : writer.order) joints.push_back(ToWritten(motion.skeleton.joint(index)));
  // Angles of joints that are written otherwise than they are, kept continuous from frame to frame.
  std::vector<Eigen::Vector3d> angles(joints.size(), Eigen::Vector3d::Zero());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd q = motion.q.col(frame);
    const Eigen::Vector3d root = 100 * body::ToYUp(Eigen::Vector3d(q.head<3>()));
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) text += ' ';
      text::AppendFixed(text, root(axis), kDecimals);
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i].as_it_is) {
        angles[i] = q.segment<3>(joints[i].joint.first_dof);
      } else {
        const Joint& joint = motion.skeleton.joint(writer.order[i]);
        Eigen::VectorXd held = angles[i];
        SetJointRotation(joints[i].joint, JointRotation(joint, q), held);
        angles[i] = held;
      }
      for (int axis = 0; axis < 3; ++axis) {
        text += ' ';
        text::AppendFixed(text, RadiansToDegrees(angles[i](axis)), kDecimals);
      }
    }
    text += '\n';
  }
  return text;
}

namespace {

/// The joints from `top` on, with `top` as the root.
body::Skeleton From(const body::Skeleton& skeleton, int top) {
  std::vector<Joint> joints(skeleton.joints.begin() + top, skeleton.joints.end());
  for (Joint& joint : joints) joint.parent -= top;
  Joint& root = joints.front();
  root.parent = -1;
  root.offset_m.setZero();
  if (root.rotations.size() < 3) {
    root.rotations.clear();
    for (const Axis axis : {Axis::kZ, Axis::kX, Axis::kY}) {
      root.rotations.push_back({axis, -body::kUnlimited, body::kUnlimited});
    }
  }
  return body::MakeSkeleton(std::move(joints));
}

}  // namespace

int StemLength(const body::Skeleton& skeleton) {
  std::vector<int> children(skeleton.joints.size(), 0);
  for (const Joint& joint : skeleton.joints) {
    if (joint.parent >= 0) ++children[static_cast<std::size_t>(joint.parent)];
  }
  const auto branch =
      std::find_if(children.begin(), children.end(), [](int count) { return count != 1; });
  return branch == children.end() || *branch == 0 ? 0 : static_cast<int>(branch - children.begin());
}

Motion OnMovingJoint(Motion motion, const Eigen::MatrixXd& stem_m, double still_m) {
  int top = static_cast<int>(stem_m.rows() / 3);
  while (top > 0) {
    const auto places = stem_m.middleRows<3>(3 * (top - 1));
    if (((places.colwise() - places.col(0)).array().abs() > still_m).any()) break;
    motion.skeleton.joints[static_cast<std::size_t>(top)].offset_m = places.col(0);
    --top;
  }
  if (top == 0) return motion;
  const body::Skeleton& from = motion.skeleton;
  Motion out{From(from, top), motion.rate_hz, motion.start_s, {}};
  out.q.resize(out.skeleton.dof, motion.frames());
  const Joint& root = out.skeleton.joint(0);
  const auto behind_root = static_cast<Eigen::Index>(3 + root.rotations.size());
  const Eigen::Index rest = out.skeleton.dof - behind_root;
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd q = motion.q.col(frame);
    Eigen::Vector3d place_m = q.head<3>();
    Eigen::Matrix3d turn = JointRotation(from.joint(0), q);
    for (int i = 1; i <= top; ++i) {
      place_m += turn * stem_m.col(frame).segment<3>(3 * (i - 1));
      turn *= JointRotation(from.joint(i), q);
    }
    Eigen::VectorXd to = Eigen::VectorXd::Zero(out.skeleton.dof);
    if (frame > 0) to = out.q.col(frame - 1);  // The nearest angles.
    to.head<3>() = place_m;
    SetJointRotation(root, turn, to);
    to.tail(rest) = q.tail(rest);
    out.q.col(frame) = to;
  }
  return out;
}

}  // namespace footing::motion
