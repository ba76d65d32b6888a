#include "clients/log/align.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "clients/log/contents.h"
#include "clients/log/export_bodies.h"
#include "common/base/low_pass.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/body/body.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/files.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "common/virtual/options/load.h"
#include "common/wire/wire.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::log_client {
namespace {

using body::Landmark;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kSilenceS = 0.2;  // Longer without a sample, a board says nothing.
constexpr std::size_t kMostCsvBytes = 512u << 20;

/// One sample of a board.
struct BoardReading {
  double time_s = 0, load_n = 0;
  Vector2d cop_W_m = Vector2d::Constant(kUnmeasured);
};

/// The boards of a rig, as far as the recording has been read.
class BoardReader {
 public:
  BoardReader(std::string rig, std::int64_t first_ns) : rig_(std::move(rig)), first_ns_(first_ns) {}

  Result<void> Take(const v1::Tick& tick) {
    for (const v1::RigSetup& setup : tick.setup().rigs()) {
      layouts_[setup.rig()] = board::LayoutOr(wire::FromProto(setup.layout()));
    }
    for (const v1::DeviceStatus& status : tick.status().devices()) Learn(status);
    for (const v1::BoardSample& sample : tick.boards().samples()) {
      const auto side = sides_.find(sample.device());
      if (side == sides_.end()) continue;
      if (sample.uncalibrated()) {
        return InvalidData(
            "a board sent forces without its calibration; pair it again (footing-ctl doctor) and "
            "record again");
      }
      Add(sample, side->second);
    }
    return {};
  }
  /// A start of the server numbers its devices again.
  void Restart() { sides_.clear(); }

  Result<BoardForces> Finish() const {
    double from_s = std::numeric_limits<double>::infinity(), to_s = -from_s;
    for (const auto& readings : readings_) {
      if (readings.empty()) continue;
      from_s = std::min(from_s, readings.front().time_s);
      to_s = std::max(to_s, readings.back().time_s);
    }
    if (!(to_s > from_s)) return InvalidData("no board sent forces; record footingd");
    if (to_s - from_s > kLongestSeriesS) {
      return InvalidData("the boards' samples span " + text::Fixed((to_s - from_s) / 60, 0) +
                         " minutes, more than two hours");
    }
    BoardForces forces;
    const auto count = static_cast<Index>((to_s - from_s) * kSeriesRateHz) + 1;
    forces.total = {kSeriesRateHz, from_s, VectorXd::Zero(count)};
    for (std::size_t side = 0; side < 2; ++side) {
      if (readings_[side].empty()) continue;
      Fill(readings_[side], from_s, count, forces.load_n[side], forces.cop_W_m[side]);
      forces.total.force_n += forces.load_n[side];
    }
    return forces;
  }

 private:
  void Learn(const v1::DeviceStatus& status) {
    const bool left = status.role() == v1::DEVICE_ROLE_LEFT_BOARD;
    if (!left && status.role() != v1::DEVICE_ROLE_RIGHT_BOARD) return;
    if (rig_.empty()) rig_ = status.rig();
    if (status.rig() == rig_) sides_[status.device()] = left ? 0 : 1;
  }

  void Add(const v1::BoardSample& sample, std::size_t side) {
    const std::int64_t time_ns =
        sample.sampled_ns() > 0 ? sample.sampled_ns() : sample.received_ns();
    BoardReading reading{NanosecondsToSeconds(time_ns - first_ns_), sample.total_n()};
    std::vector<BoardReading>& readings = readings_[side];
    const bool later = readings.empty() || reading.time_s > readings.back().time_s;
    if (!later || !std::isfinite(reading.load_n)) return;  // Its sensor's sample, once more.
    if (sample.cop_valid()) {
      const stream::BoardLayout layout =
          layouts_.contains(rig_) ? layouts_.at(rig_) : board::DefaultLayout();
      reading.cop_W_m = board::InWorld(side == 0 ? layout.left : layout.right, sample.cop_x_m(),
                                       sample.cop_y_m());
    }
    readings.push_back(reading);
  }

  static void Fill(const std::vector<BoardReading>& readings, double from_s, Index count,
                   VectorXd& load_n, Eigen::Matrix2Xd& cop_W_m) {
    load_n.setConstant(count, kUnmeasured);
    cop_W_m.setConstant(2, count, kUnmeasured);
    std::size_t after = 0;
    for (Index i = 0; i < count; ++i) {
      const double time_s = from_s + static_cast<double>(i) / kSeriesRateHz;
      while (after < readings.size() && readings[after].time_s < time_s) ++after;
      if (after == 0 || after == readings.size()) continue;
      const BoardReading &a = readings[after - 1], &b = readings[after];
      if (b.time_s - a.time_s > kSilenceS) continue;
      const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
      load_n(i) = (1 - share) * a.load_n + share * b.load_n;
      cop_W_m.col(i) = (1 - share) * a.cop_W_m + share * b.cop_W_m;
    }
  }

  std::string rig_;
  std::int64_t first_ns_;
  std::map<std::string, stream::BoardLayout> layouts_;
  std::map<std::uint32_t, std::size_t> sides_;  ///< By device.
  std::array<std::vector<BoardReading>, 2> readings_;
};

/// Log time of the recording's first message of a server, ns.
std::int64_t FirstNs(const recording::RecordedSession& session) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  for (const auto& server : session.servers()) {
    for (const auto& tick : server.ticks) first_ns = std::min(first_ns, tick.host_ns);
  }
  return first_ns;
}

}  // namespace

Result<BoardForces> ReadBoards(const recording::RecordedSession& session, const std::string& rig) {
  BoardReader reader(rig, FirstNs(session));
  for (const recording::RecordedServer& server : session.servers()) {
    if (server.server_id != "footingd") continue;
    reader.Restart();
    const auto ticks = recording::ReadTicks(
        server,
        {v1::Tick::kStatusFieldNumber, v1::Tick::kSetupFieldNumber, v1::Tick::kBoardsFieldNumber});
    if (!ticks) return ticks.error();
    for (const v1::Tick& tick : *ticks) {
      if (const auto taken = reader.Take(tick); !taken) {
        return InvalidData(session.path() + ": " + taken.error().message);
      }
    }
  }
  auto forces = reader.Finish();
  if (!forces) return InvalidData(session.path() + ": " + forces.error().message);
  return forces;
}

namespace {

/// Joint centres of every frame.
class Person {
 public:
  explicit Person(const motion::MarkerTracks& tracks) : tracks_(tracks) {
    if (auto set = motion::FindMarkerSet(tracks)) {
      set_ = *std::move(set);
      return;
    }
    for (std::size_t i = 0; i < tracks.names.size(); ++i) Learn(tracks.names[i], i);
  }

  motion::Centres At(Index frame) const {
    if (set_) return motion::JointCentres(tracks_, *set_, frame);
    motion::Centres centres;
    for (const auto& [landmark, track] : keypoints_) {
      const Vector3d p = tracks_.p[track].col(frame);
      if (motion::Seen(p)) centres[static_cast<std::size_t>(landmark)] = p;
    }
    return centres;
  }
  /// Hips, knees, ankles and shoulders have names that are known.
  bool is_known() const { return set_.has_value() || keypoints_.size() >= 8; }

 private:
  /// Names of video keypoints: "LKnee", "left_knee", "RBigToe".
  void Learn(const std::string& name, std::size_t track) {
    std::string word;
    for (const char c : text::Lower(name.substr(name.rfind(':') + 1))) {
      if (c != '_' && c != '.' && c != '-' && c != ' ') word += c;
    }
    constexpr std::pair<std::string_view, Landmark> kNames[] = {
        {"hip", Landmark::kLeftHip},           {"knee", Landmark::kLeftKnee},
        {"ankle", Landmark::kLeftAnkle},       {"bigtoe", Landmark::kLeftToe},
        {"shoulder", Landmark::kLeftShoulder}, {"elbow", Landmark::kLeftElbow},
        {"wrist", Landmark::kLeftWrist}};
    for (const auto& [joint, left] : kNames) {
      for (const int side : {0, 1}) {
        const std::string sided = (side == 0 ? "left" : "right") + std::string(joint);
        const bool is_it = word == sided || word == (side == 0 ? "l" : "r") + std::string(joint);
        if (is_it) keypoints_.emplace(body::OfSide(left, side), track);
      }
    }
  }

  const motion::MarkerTracks& tracks_;
  std::optional<motion::MarkerSet> set_;
  std::map<Landmark, std::size_t> keypoints_;
};

/// Height of the centre of mass of a person with these joint centres, by de Leva's segments; an arm
/// or toe that is not seen counts where the joint above it is. NaN where more is missing.
double HeightOf(const motion::Centres& centres) {
  using body::Parameters;
  using body::Segment;
  constexpr body::Sex kSex = body::Sex::kMean;
  const auto z = [&centres](Landmark left, int side, double otherwise) {
    const auto& p = centres[static_cast<std::size_t>(body::OfSide(left, side))];
    return p ? p->z() : otherwise;
  };
  double hips = 0, shoulders = 0, height = 0;
  const auto add = [&height](Segment segment, double from, double to) {
    const body::SegmentParameters part = Parameters(segment, kSex);
    height += part.mass_of_body * (from + part.centre_of_length * (to - from));
  };
  for (const int side : {0, 1}) {
    const double hip = z(Landmark::kLeftHip, side, kUnmeasured);
    const double shoulder = z(Landmark::kLeftShoulder, side, kUnmeasured);
    const double knee = z(Landmark::kLeftKnee, side, kUnmeasured);
    const double ankle = z(Landmark::kLeftAnkle, side, kUnmeasured);
    const double elbow = z(Landmark::kLeftElbow, side, shoulder);
    const double wrist = z(Landmark::kLeftWrist, side, elbow);
    hips += hip / 2;
    shoulders += shoulder / 2;
    add(Segment::kThigh, hip, knee);
    add(Segment::kShank, knee, ankle);
    add(Segment::kFoot, ankle, z(Landmark::kLeftToe, side, ankle));
    add(Segment::kUpperArm, shoulder, elbow);
    add(Segment::kForearm, elbow, wrist);
    add(Segment::kHand, wrist, wrist);
  }
  const auto on_trunk = [&](Segment segment, double share) {
    height += Parameters(segment, kSex).mass_of_body * (hips + share * (shoulders - hips));
  };
  for (const Segment part : {Segment::kUpperTrunk, Segment::kMiddleTrunk, Segment::kLowerTrunk}) {
    on_trunk(part, body::TrunkCentre(part, kSex));
  }
  const body::SegmentParameters head = Parameters(Segment::kHead, kSex);
  on_trunk(Segment::kHead, body::CervicaleOnTrunk(kSex) + head.centre_of_length *
                                                              head.length_of_stature /
                                                              body::TrunkOfStature(kSex));
  return height;
}

/// The mean of all markers of a frame; NaN unless all are seen, or it would jump.
double MeanHeight(const motion::MarkerTracks& tracks, Index frame) {
  double sum = 0;
  for (const Eigen::Matrix3Xd& track : tracks.p) sum += track(2, frame);
  return sum / static_cast<double>(tracks.p.size());
}

}  // namespace

VectorXd CentreOfMassHeight(const motion::MarkerTracks& tracks, std::string& note) {
  const Person person(tracks);
  if (!person.is_known()) {
    note =
        "the names of the markers are not known, so the mean of all of them is taken for the "
        "centre of mass";
  }
  return VectorXd::NullaryExpr(tracks.frames(), [&](Index frame) {
    return person.is_known() ? HeightOf(person.At(frame)) : MeanHeight(tracks, frame);
  });
}

namespace {

// A person who stands, squats or jumps: from the lowest to the highest marker, m.
constexpr double kLeastExtentM = 0.5, kMostExtentM = 3;
constexpr double kMarkersCutoffHz = 8;

/// The vertical force on somebody of this weight whose centre of mass moves so.
VectorXd ForceOf(const VectorXd& height_m, double rate_hz, double weight_n) {
  VectorXd filled = height_m;
  for (Index i = 0; i < filled.size(); ++i) {
    if (!std::isfinite(filled(i))) filled(i) = i > 0 ? filled(i - 1) : 0;
  }
  for (Index i = filled.size() - 2; i >= 0; --i) {
    if (!std::isfinite(height_m(i)) && filled(i) == 0) filled(i) = filled(i + 1);
  }
  const VectorXd z = footing::LowPass(filled.transpose(), rate_hz, kMarkersCutoffHz).row(0);
  VectorXd force = VectorXd::Constant(z.size(), kUnmeasured);
  for (Index i = 1; i + 1 < z.size(); ++i) {
    if (!height_m.segment(i - 1, 3).allFinite()) continue;
    const double acceleration_mps2 = (z(i + 1) - 2 * z(i) + z(i - 1)) * rate_hz * rate_hz;
    force(i) = weight_n * (1 + acceleration_mps2 / kStandardGravityMps2);
  }
  return force;
}

Result<ForeignMotion> FromMarkers(motion::MarkerTracks tracks, const std::string& path,
                                  double standing_n) {
  if (tracks.p.empty() || tracks.frames() < 3) {
    return InvalidData(path + ": has neither force plates nor markers");
  }
  std::vector<double> extents;
  for (Index frame = 0; frame < tracks.frames(); frame += 10) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Eigen::Matrix3Xd& track : tracks.p) {
      if (!motion::Seen(track.col(frame))) continue;
      low = std::min(low, track(2, frame));
      high = std::max(high, track(2, frame));
    }
    if (high > low) extents.push_back(high - low);
  }
  if (extents.empty()) return InvalidData(path + ": no frame has two markers");
  const auto middle = extents.begin() + std::ssize(extents) / 2;
  std::nth_element(extents.begin(), middle, extents.end());
  if (*middle < kLeastExtentM || *middle > kMostExtentM) {
    return InvalidData(path + ": the markers are " + text::Fixed(*middle, 3) +
                       " m high, which is not a person: check the unit of the file");
  }
  ForeignMotion foreign;
  foreign.from_markers = true;
  const VectorXd height_m = CentreOfMassHeight(tracks, foreign.note);
  foreign.force = {tracks.rate_hz, tracks.start_s, ForceOf(height_m, tracks.rate_hz, standing_n)};
  foreign.markers = std::move(tracks);
  return foreign;
}

/// A table with the columns time_s and force_n, at equal steps.
Result<Series> ReadForceCsv(const std::string& path) {
  const auto text = config::ReadTextFile(path, kMostCsvBytes);
  if (!text) return text.error();
  text::Lines lines(*text, path);
  const auto header = lines.NextRow();
  if (!header) return InvalidData(path + ": is empty");
  const auto names = text::Cells(*header);
  const auto column = [&](std::string_view name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  const auto time = column("time_s"), force = column("force_n");
  if (time == std::ssize(names) || force == std::ssize(names)) {
    return lines.Fault("needs the columns time_s and force_n (the vertical force, N)");
  }
  std::vector<double> times, forces;
  while (const auto line = lines.NextRow()) {
    const auto row = text::NumberRow(*line, names.size());
    if (!row) return lines.Fault(row.error().message);
    times.push_back((*row)[static_cast<std::size_t>(time)]);
    forces.push_back((*row)[static_cast<std::size_t>(force)]);
  }
  const auto count = std::ssize(times);
  const double step_s =
      count < 3 ? 0 : (times.back() - times.front()) / static_cast<double>(count - 1);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const double equal_s = times.front() + static_cast<double>(i) * step_s;
    if (step_s > 0 && std::abs(times[static_cast<std::size_t>(i)] - equal_s) <= 0.5 * step_s)
      continue;
    return InvalidData(path + ": the times are not at equal steps");
  }
  if (!(step_s > 0)) return InvalidData(path + ": needs three rows");
  return Series{motion::RateOfStep(step_s), times.front(),
                Eigen::Map<const VectorXd>(forces.data(), count)};
}

Series TotalOf(const motion::GroundForces& forces) {
  Series total{forces.rate_hz, forces.start_s, {}};
  for (const motion::PlateForces& plate : forces.plates) {
    if (total.force_n.size() == 0) total.force_n.setZero(plate.force_W.cols());
    total.force_n += plate.force_W.row(2).transpose();
  }
  return total;
}

}  // namespace

Result<ForeignMotion> ReadForeign(const std::string& path, double standing_n) {
  const std::string ending = text::Lower(std::filesystem::path(path).extension().string());
  ForeignMotion foreign;
  if (ending == ".csv") {
    auto force = ReadForceCsv(path);
    if (!force) return force.error();
    foreign.force = *std::move(force);
  } else if (ending == ".mot" || ending == ".sto") {
    const auto forces = motion_files::LoadForces(path);
    if (!forces) return forces.error();
    foreign.force = TotalOf(*forces);
  } else if (ending == ".c3d" || ending == ".trc") {
    auto markers = motion_files::LoadMarkers(path);
    if (!markers) return markers.error();
    std::string why;
    if (ending == ".c3d") {
      const auto forces = motion_files::LoadForces(path);
      if (forces) foreign.force = TotalOf(*forces);
      if (!forces) why = forces.error().message;
    }
    if (foreign.force.force_n.size() == 0) {
      auto of_markers = FromMarkers(*std::move(markers), path, standing_n);
      if (of_markers && of_markers->note.empty()) of_markers->note = why;
      return of_markers;
    }
    if (!markers->p.empty()) foreign.markers = *std::move(markers);
  } else {
    return UsageError("--with takes .c3d, .trc, .mot, .sto or .csv, not " + path);
  }
  if (foreign.force.force_n.size() < 3) return InvalidData(path + ": has no force over time");
  return foreign;
}

namespace {

/// How the boards' floor lies in the file's: turned about the vertical, then moved.
struct Floor {
  Eigen::Rotation2Dd turn{0};
  Vector2d shift_m = Vector2d::Zero();
  std::optional<double> rms_m;
};

/// The feet press where the boards are pressed: least squares, once more without what is far off.
Floor PlaceFloor(const std::vector<std::pair<Vector2d, Vector2d>>& pairs) {
  constexpr double kFarM = 0.15;
  constexpr std::size_t kFewest = 50;
  Floor floor;
  std::vector<std::pair<Vector2d, Vector2d>> used = pairs;
  for (int pass = 0; pass < 2; ++pass) {
    if (used.size() < kFewest) return {};
    Vector2d from = Vector2d::Zero(), to = Vector2d::Zero();
    for (const auto& [a, b] : used) {
      from += a / static_cast<double>(used.size());
      to += b / static_cast<double>(used.size());
    }
    double along = 0, across = 0;
    for (const auto& [a, b] : used) {
      const Vector2d p = a - from, q = b - to;
      along += p.dot(q);
      across += p.x() * q.y() - p.y() * q.x();
    }
    floor.turn = Eigen::Rotation2Dd(std::atan2(across, along));
    floor.shift_m = to - floor.turn * from;
    const auto off = [&floor](const auto& pair) {
      return (floor.turn * pair.first + floor.shift_m - pair.second).norm();
    };
    double sum = 0;
    for (const auto& pair : used) sum += off(pair) * off(pair);
    floor.rms_m = std::sqrt(sum / static_cast<double>(used.size()));
    std::erase_if(used, [&](const auto& pair) { return off(pair) > kFarM; });
  }
  return floor;
}

/// The boards' loads at the frames of the file.
class FrameForces {
 public:
  FrameForces(const BoardForces& boards, const ForeignMotion& foreign, double offset_s)
      : boards_(boards), foreign_(foreign), offset_s_(offset_s) {}

  double rate_hz() const { return Clock().rate_hz; }
  double start_s() const { return Clock().start_s; }

  /// Where the boards lie in the file's frame.
  Floor Place() const {
    std::vector<std::pair<Vector2d, Vector2d>> pairs;
    if (!foreign_.markers) return {};
    const Person person(*foreign_.markers);
    const double least_n = 0.2 * StandingForce(boards_.total);
    for (Index frame = 0; frame < foreign_.markers->frames(); ++frame) {
      const motion::Centres centres = person.At(frame);
      for (const int side : {0, 1}) {
        const auto& ankle =
            centres[static_cast<std::size_t>(body::OfSide(Landmark::kLeftAnkle, side))];
        const auto& toe = centres[static_cast<std::size_t>(body::OfSide(Landmark::kLeftToe, side))];
        const auto load = At(frame, static_cast<std::size_t>(side));
        if (!ankle || !toe || !load || load->load_n < least_n) continue;
        pairs.emplace_back(load->cop_W.head<2>(), ((*ankle + *toe) / 2).head<2>());
      }
    }
    return PlaceFloor(pairs);
  }

  /// A row a frame; without a measurement the force is 0. Counts the frames in which a board said
  /// nothing.
  std::vector<motion::FootForces> Rows(const Floor& floor, std::uint64_t& unmeasured) const {
    std::vector<motion::FootForces> rows(static_cast<std::size_t>(frames()));
    for (Index frame = 0; frame < frames(); ++frame) {
      bool measured = true;
      for (const std::size_t side : {0, 1}) {
        const auto load = At(frame, side);
        measured = measured && (load || boards_.load_n[side].size() == 0);
        if (!load || load->load_n < kLeastN) continue;
        motion::FootForce& foot = rows[static_cast<std::size_t>(frame)][side];
        foot.load_n = load->load_n;
        foot.cop_W.head<2>() = floor.turn * load->cop_W.head<2>() + floor.shift_m;
      }
      unmeasured += measured ? 0 : 1;
    }
    return rows;
  }

 private:
  static constexpr double kLeastN = 10;  // Less has no centre of pressure.

  struct FileClock {
    double rate_hz, start_s;
    Index frames;
  };
  FileClock Clock() const {
    if (foreign_.markers) {
      return {foreign_.markers->rate_hz, foreign_.markers->start_s, foreign_.markers->frames()};
    }
    return {foreign_.force.rate_hz, foreign_.force.start_s, foreign_.force.force_n.size()};
  }
  Index frames() const { return Clock().frames; }

  /// The load of one foot; nothing where its board says nothing or its COP is not known.
  std::optional<motion::FootForce> At(Index frame, std::size_t side) const {
    const double time_s = start_s() + static_cast<double>(frame) / rate_hz() + offset_s_;
    const double place = (time_s - boards_.total.start_s) * boards_.total.rate_hz;
    const VectorXd& load_n = boards_.load_n[side];
    if (!(place >= 0) || place >= static_cast<double>(load_n.size() - 1)) return std::nullopt;
    const auto i = static_cast<Index>(place);
    const double share = place - static_cast<double>(i);
    motion::FootForce force;
    force.load_n = (1 - share) * load_n(i) + share * load_n(i + 1);
    if (!std::isfinite(force.load_n)) return std::nullopt;
    force.cop_W.head<2>() =
        (1 - share) * boards_.cop_W_m[side].col(i) + share * boards_.cop_W_m[side].col(i + 1);
    if (!force.cop_W.allFinite()) {
      force.cop_W.setZero();
      force.load_n = 0;
    }
    return force;
  }

  const BoardForces& boards_;
  const ForeignMotion& foreign_;
  const double offset_s_;
};

constexpr char kMissing[] =
    "Vertical forces and centres of pressure of Balance Boards; shear forces and free moments are "
    "not measured and stand as 0";

Result<void> WriteForces(const AlignOptions& options, const BoardForces& boards,
                         const ForeignMotion& foreign, Alignment& alignment) {
  const FrameForces frames(boards, foreign, alignment.offset->offset_s);
  const Floor floor = frames.Place();
  const auto rows = frames.Rows(floor, alignment.unmeasured_frames);
  alignment.frames = rows.size();
  alignment.placement_rms_m = floor.rms_m;
  if (alignment.unmeasured_frames == alignment.frames) {
    return InvalidData("the boards measured nothing while " + options.with + " was recorded");
  }
  motion::Table table = motion::ForceTable(rows, frames.rate_hz());
  table.values.col(0).array() += frames.start_s();
  const std::string name = std::filesystem::path(options.with).stem().string();
  table.name = name + "_grf.mot";
  if (const auto made = MakeFolder(options.out); !made) return made;
  const std::string note =
      std::string(kMissing) + (floor.rms_m ? "" : "; the places are in the boards' own frame");
  for (const auto& [file, text] :
       {std::pair(table.name, motion::WithNote(motion::WriteTable(table), note)),
        std::pair(name + "_loads.xml", motion::ExternalLoads(name))}) {
    const std::string path = options.out + "/" + file;
    auto out = recording::OutputFile::Create(path, options.replace);
    if (!out) return out.error();
    if (const auto written = out->Write(text); !written) return written;
    alignment.files.push_back(path);
  }
  return {};
}

/// Time of the one event of a C3D file with this label, s.
Result<double> C3dEvent(const std::string& path, const std::string& label) {
  const auto text = config::ReadTextFile(path, kMostCsvBytes);
  if (!text) return text.error();
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
  const std::size_t begin = bytes.empty() ? 0 : (bytes[0] - 1u) * motion::kC3dBlock;
  if (bytes.size() < begin + 4 || bytes[0] == 0) return InvalidData(path + ": is not a C3D file");
  const motion::C3dReader reader(bytes, static_cast<motion::Processor>(bytes[begin + 3]));
  const auto parameters = motion::ParseC3dParameters(reader, begin, path);
  if (!parameters) return parameters.error();
  const auto labels = parameters->texts.find("EVENT:LABELS");
  const auto times = parameters->numbers.find("EVENT:TIMES");
  if (labels == parameters->texts.end() || times == parameters->numbers.end()) {
    return InvalidData(path + ": has no events; name the marker's time in it with --at");
  }
  for (std::size_t i = 0; i < labels->second.size() && 2 * i + 1 < times->second.size(); ++i) {
    if (text::Trim(labels->second[i]) != label) continue;
    // Minutes and seconds since the trial's first frame, with which the file need not begin.
    const double begins_s =
        (reader.Unsigned(6) - 1.0) / parameters->Number("POINT:RATE", kSeriesRateHz);
    return 60 * times->second[2 * i] + times->second[2 * i + 1] - begins_s;
  }
  return InvalidData(path + ": has no event " + text::Quoted(label) +
                     "; name the marker's time in it with --at");
}

/// Time of the one marker with this text, s from the recording's start.
Result<double> MarkerTime(const recording::RecordedSession& session, const std::string& marker) {
  std::vector<double> found;
  for (const recording::RecordedServer& server : session.servers()) {
    const auto ticks = recording::ReadTicks(server, {v1::Tick::kEventsFieldNumber});
    if (!ticks) return ticks.error();
    for (const v1::Tick& tick : *ticks) {
      for (const v1::Event& event : tick.events().events()) {
        if (event.kind() != v1::Event::KIND_MARKER || event.text() != marker) continue;
        found.push_back(NanosecondsToSeconds(event.host_ns() - FirstNs(session)));
      }
    }
  }
  if (found.size() == 1) return found.front();
  return InvalidData(session.path() + ": has " + std::to_string(found.size()) + " markers " +
                     text::Quoted(marker) + "; one is needed");
}

/// The offset by what both clocks have in common. What nobody measured is within half a frame.
Result<TimeOffset> KnownOffset(const AlignOptions& options,
                               const recording::RecordedSession& session, const Series& theirs) {
  TimeOffset offset;
  offset.sure = true;
  offset.sd_s = std::hypot(0.5 / std::sqrt(3) / theirs.rate_hz, 0.001);
  if (options.lsl_clock) {
    offset.offset_s = -NanosecondsToSeconds(FirstNs(session));
    return offset;
  }
  const auto ours_s = MarkerTime(session, options.marker);
  if (!ours_s) return ours_s.error();
  const auto theirs_s =
      options.at_s ? Result<double>(*options.at_s) : C3dEvent(options.with, options.marker);
  if (!theirs_s) return theirs_s.error();
  offset.offset_s = *ours_s - *theirs_s;
  return offset;
}

/// Whether the file was recorded while the boards were.
Result<void> CheckOverlap(const AlignOptions& options, const BoardForces& boards,
                          const Series& theirs, double offset_s) {
  const double from_s = theirs.start_s + offset_s;
  const double to_s = from_s + static_cast<double>(theirs.force_n.size()) / theirs.rate_hz;
  const double end_s = boards.total.start_s +
                       static_cast<double>(boards.total.force_n.size()) / boards.total.rate_hz;
  if (from_s < end_s && to_s > boards.total.start_s) return {};
  return InvalidData(options.with + " and " + options.file +
                     " do not overlap: the file goes from " + text::Fixed(from_s, 1) + " to " +
                     text::Fixed(to_s, 1) + " s of the recording, the boards' forces from " +
                     text::Fixed(boards.total.start_s, 1) + " to " + text::Fixed(end_s, 1) + " s");
}

}  // namespace

Result<Alignment> Align(const AlignOptions& options) {
  const auto session = recording::RecordedSession::Open(options.file);
  if (!session) return session.error();
  const auto boards = ReadBoards(*session, options.rig);
  if (!boards) return boards.error();
  const double standing_n = StandingForce(boards->total);
  if (!(standing_n > 0)) return InvalidData(options.file + ": nobody stands on the boards");
  const auto foreign = ReadForeign(options.with, standing_n);
  if (!foreign) return foreign.error();
  const Series& theirs = foreign->force;
  if (static_cast<double>(theirs.force_n.size()) > kLongestSeriesS * theirs.rate_hz) {
    return InvalidData(options.with + ": is longer than two hours");
  }
  Alignment alignment;
  alignment.note = foreign->note;
  if (options.lsl_clock || !options.marker.empty()) {
    alignment.method = options.lsl_clock ? "lsl" : "marker";
    const auto known = KnownOffset(options, *session, theirs);
    if (!known) return known.error();
    alignment.offset = *known;
    if (const auto overlap = CheckOverlap(options, *boards, theirs, known->offset_s); !overlap) {
      return overlap.error();
    }
  } else {
    alignment.method = foreign->from_markers ? "markers" : "forces";
    alignment.offset =
        FindOffset(boards->total, theirs,
                   {.from_markers = foreign->from_markers, .most_sd_s = options.most_sd_s});
  }
  if (options.out.empty() || !alignment.offset || !alignment.offset->sure) return alignment;
  const auto written = WriteForces(options, *boards, *foreign, alignment);
  if (!written) return written.error();
  return alignment;
}

}  // namespace footing::log_client
