#include "common/virtual/motion/markers.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "common/base/text.h"
#include "common/body/skeleton.h"

namespace footing::motion {

int FindMarker(const MarkerTracks& tracks, std::string_view name) {
  for (std::size_t i = 0; i < tracks.names.size(); ++i) {
    if (tracks.names[i] == name) return static_cast<int>(i);
  }
  return -1;
}

Result<void> CheckSeen(const MarkerTracks& tracks, std::size_t least, double longest_s) {
  Eigen::Index last = -1;  // Frame with enough of them.
  for (Eigen::Index frame = 0; frame < tracks.frames(); ++frame) {
    const auto seen = std::count_if(tracks.p.begin(), tracks.p.end(),
                                    [&](const auto& track) { return Seen(track.col(frame)); });
    if (static_cast<std::size_t>(seen) >= least) last = frame;
    if (static_cast<double>(frame - last) <= longest_s * tracks.rate_hz) continue;
    const double from_s = tracks.start_s + static_cast<double>(last + 1) / tracks.rate_hz;
    return InvalidData("fewer than " + std::to_string(least) + " markers are seen for more than " +
                       text::Fixed(longest_s, 1) + " s from " + text::Fixed(from_s, 2) +
                       " s on; cut the trial there");
  }
  return {};
}

Eigen::Vector3d ToWorld(FileAxes axes, const Eigen::Vector3d& p) {
  switch (axes) {
    case FileAxes::kZUp:
      return p;
    case FileAxes::kYUp:
      return {p.x(), -p.z(), p.y()};
    case FileAxes::kYUpZAhead:
      return body::FromYUp(p);
  }
  return p;
}

MarkerTracks ToWorld(FileAxes axes, MarkerTracks tracks) {
  for (Eigen::Matrix3Xd& track : tracks.p) {
    for (Eigen::Index frame = 0; frame < track.cols(); ++frame) {
      track.col(frame) = ToWorld(axes, Eigen::Vector3d(track.col(frame)));
    }
  }
  return tracks;
}

namespace {

constexpr std::array<MarkerSet, 5> kSets = {{
    {.name = "opencap",  // OpenCap's validation set, 51 markers; medial ones in its static trial.
     .left = "L l",
     .right = "r R",
     .asis = "@.ASIS",
     .psis = "@.PSIS",
     .knee_lateral = "@_knee",
     .knee_medial = "@_mknee",
     .ankle_lateral = "@_ankle",
     .ankle_medial = "@_mankle",
     .heel = "@_calc",
     .toe = "@_toe",
     .fifth_metatarsal = "@_5meta",
     .shoulder = "@_Shoulder",
     .shoulder_over_joint_m = 0.04,
     .elbow_lateral = "@_elbow_lat",
     .elbow_medial = "@_elbow_med",
     .wrist_radius = "@_wrist_radius",
     .wrist_ulna = "@_wrist_ulna",
     .hand = "",
     .cervicale = "C7",
     .sternum = "L_Sternum R_Sternum",
     .head = ""},
    {.name = "plug-in-gait",  // Vicon's full body.
     .left = "L",
     .right = "R",
     .asis = "@ASI",
     .psis = "@PSI | SACR",
     .knee_lateral = "@KNE",
     .knee_medial = "@KNM",
     .ankle_lateral = "@ANK",
     .ankle_medial = "@MED",
     .heel = "@HEE",
     .toe = "@TOE",
     .fifth_metatarsal = "@MT5",
     .shoulder = "@SHO",
     .shoulder_over_joint_m = 0.04,
     .elbow_lateral = "@ELB",
     .elbow_medial = "@ELM",
     .wrist_radius = "@WRA",
     .wrist_ulna = "@WRB",
     .hand = "@FIN",
     .cervicale = "C7",
     .sternum = "CLAV",
     .head = "LFHD RFHD LBHD RBHD"},
    {.name = "cmu41",  // Set of the CMU database: waist markers front and back.
     .left = "L",
     .right = "R",
     .asis = "@FWT",
     .psis = "@BWT",
     .knee_lateral = "@KNE",
     .knee_medial = "",
     .ankle_lateral = "@ANK",
     .ankle_medial = "",
     .heel = "@HEE",
     .toe = "@TOE",
     .fifth_metatarsal = "@MT5",
     .shoulder = "@SHO",
     .shoulder_over_joint_m = 0.04,
     .elbow_lateral = "@ELB",
     .elbow_medial = "",
     .wrist_radius = "@WRA",
     .wrist_ulna = "@WRB",
     .hand = "@FIN",
     .cervicale = "C7",
     .sternum = "CLAV",
     .head = "LFHD RFHD LBHD RBHD"},
    {.name = "vicon53",  // The 53 markers of the pose paper's laboratory.
     .left = "L",
     .right = "R",
     .asis = "@FWT",
     .psis = "@BWT",
     .knee_lateral = "@KNE",
     .knee_medial = "@KNI",
     .ankle_lateral = "@ANK",
     .ankle_medial = "",
     .heel = "@HEL",
     .toe = "@MT1 @MT5",
     .fifth_metatarsal = "@MT5",
     .shoulder = "@FSH @BSH",
     .shoulder_over_joint_m = 0.02,
     .elbow_lateral = "@ELB",
     .elbow_medial = "@IEL",
     .wrist_radius = "@IWR",
     .wrist_ulna = "@OWR",
     .hand = "@IHAND @OHAND",
     .cervicale = "C7",
     .sternum = "CLAV",
     .head = "LFHD RFHD LBHD RBHD"},
    {.name = "imd29",  // 29 markers, one over the sacrum.
     .left = "Lx",
     .right = "Rx",
     .asis = "@Asis",
     .psis = "Psis",
     .knee_lateral = "@LatCon",
     .knee_medial = "",
     .ankle_lateral = "@LatMal",
     .ankle_medial = "",
     .heel = "@Heel",
     .toe = "@Toe1",
     .fifth_metatarsal = "@Meta5",
     .shoulder = "@Should",
     .shoulder_over_joint_m = 0.04,
     .elbow_lateral = "@Elbow",
     .elbow_medial = "",
     .wrist_radius = "@Wrist",
     .wrist_ulna = "",
     .hand = "",
     .cervicale = "C7",
     .sternum = "",
     .head = ""},
}};

/// The fields without which there is no skeleton.
std::array<std::string_view, 10> Necessary(const MarkerSet& set) {
  return {set.asis, set.psis,     set.knee_lateral,  set.ankle_lateral, set.heel,
          set.toe,  set.shoulder, set.elbow_lateral, set.wrist_radius,  set.cervicale};
}

std::string_view WithoutSubject(std::string_view name) {
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

int Find(const MarkerTracks& tracks, std::string_view name) {
  for (std::size_t i = 0; i < tracks.names.size(); ++i) {
    if (WithoutSubject(tracks.names[i]) == name) return static_cast<int>(i);
  }
  return -1;
}

/// A field as a file of that side would name its markers, of which one is enough: "LMT1 or LMT5"
/// for "@MT1 @MT5".
std::string Spelt(const MarkerSet& set, std::string_view field, int side) {
  const auto spellings = text::SplitAtBlanks(side == 0 ? set.left : set.right);
  std::vector<std::string> names;
  for (const std::string_view word : text::SplitAtBlanks(field)) {
    if (word == "|") continue;
    std::string& name = names.emplace_back(word);
    const auto at = name.find('@');
    if (at != std::string::npos) name.replace(at, 1, spellings.front());
  }
  return text::Joined(names, " or ");
}

/// Names of the necessary fields that are missing; empty when none is.
std::string Missing(const MarkerTracks& tracks, const MarkerSet& set, int& found) {
  std::vector<std::string> missing;
  found = 0;
  for (const std::string_view field : Necessary(set)) {
    for (int side = 0; side < 2; ++side) {
      if (!MarkersOf(tracks, set, field, side).empty()) {
        ++found;
      } else {
        const std::string name = Spelt(set, field, side);
        if (missing.empty() || missing.back() != name) missing.push_back(name);  // C7 has no side.
      }
    }
  }
  return text::Joined(missing);
}

/// Error with the markers of the file, and those that the nearest set would still need.
std::string NoKnownSet(const MarkerTracks& tracks, const std::string& names) {
  std::string nearest;
  int most = -1;
  for (const MarkerSet& set : kSets) {
    int found = 0;
    const std::string missing = Missing(tracks, set, found);
    if (found <= most) continue;
    most = found;
    nearest = std::string(set.name) + ", the nearest, also needs " + missing;
  }
  return "the markers match no known set (" + names + "): " + nearest +
         "; rename them, or add a set to the table (docs/body.md, From markers); the file has " +
         std::to_string(tracks.names.size()) + " markers: " + text::Joined(tracks.names);
}

}  // namespace

std::vector<int> MarkersOf(const MarkerTracks& tracks, const MarkerSet& set, std::string_view field,
                           int side) {
  std::vector<int> found;
  for (const std::string_view word : text::SplitAtBlanks(field)) {
    if (word == "|") {
      if (!found.empty()) break;
      continue;
    }
    const auto at = word.find('@');
    int index = -1;
    if (at == std::string_view::npos) {
      index = Find(tracks, word);
    } else {
      for (const std::string_view spelling :
           text::SplitAtBlanks(side == 0 ? set.left : set.right)) {
        std::string name(word);
        name.replace(at, 1, spelling);
        index = Find(tracks, name);
        if (index >= 0) break;
      }
    }
    if (index >= 0) found.push_back(index);
  }
  return found;
}

Result<MarkerSet> FindMarkerSet(const MarkerTracks& tracks, std::string_view name) {
  std::string names;
  const MarkerSet* best = nullptr;
  int most = 0;
  for (const MarkerSet& set : kSets) {
    names += (names.empty() ? "" : ", ") + std::string(set.name);
    int found = 0;
    const std::string missing = Missing(tracks, set, found);
    if (set.name == name && missing.empty()) return set;
    if (set.name == name) {
      return InvalidData("the markers do not match set " + std::string(name) +
                         ", which also needs " + missing);
    }
    if (missing.empty() && found > most) {
      best = &set;
      most = found;
    }
  }
  if (!name.empty()) {
    return UsageError("no marker set " + text::Quoted(name) + "; there are " + names);
  }
  if (best == nullptr) return InvalidData(NoKnownSet(tracks, names));
  return *best;
}

Result<void> CheckStep(double step_m, double rate_hz, double start_s, Eigen::Index frame,
                       const std::string& what) {
  constexpr double kFastestMps = 100;  // Ten times the speed of a sprinter.
  constexpr double kLongestStepM = 2, kLongStepMps = 15;
  const double speed_mps = step_m * rate_hz;
  if (speed_mps <= kFastestMps && !(step_m > kLongestStepM && speed_mps > kLongStepMps)) return {};
  const double time_s = start_s + static_cast<double>(frame) / rate_hz;
  return InvalidData(what + " moves by " + text::Fixed(step_m, 1) + " m between frames " +
                     std::to_string(frame) + " and " + std::to_string(frame + 1) + " (" +
                     text::Fixed(time_s, 3) +
                     " s), a fault of the recording; cut it there or repair it");
}

FileAxes GuessAxes(const MarkerTracks& tracks) {
  constexpr Eigen::Index kSamples = 50;
  const Eigen::Index step = std::max<Eigen::Index>(1, tracks.frames() / kSamples);
  const auto set = FindMarkerSet(tracks);
  Eigen::Vector3d spread = Eigen::Vector3d::Zero(), rise = Eigen::Vector3d::Zero();
  for (Eigen::Index frame = 0; frame < tracks.frames(); frame += step) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Matrix3Xd& track : tracks.p) {
      const Eigen::Vector3d p = track.col(frame);
      if (Seen(p)) box.extend(p);
    }
    if (!box.isEmpty()) spread += box.sizes();
    if (!set) continue;
    for (const int side : {0, 1}) {
      const auto place = [&](std::string_view field) -> Eigen::Vector3d {
        const auto marker = static_cast<std::size_t>(MarkersOf(tracks, *set, field, side).front());
        return tracks.p[marker].col(frame);
      };
      const Eigen::Vector3d up = place(set->shoulder) - place(set->heel);
      if (Seen(up)) rise += up.cwiseAbs();
    }
  }
  const Eigen::Vector3d& along = rise.isZero(0) ? spread : rise;
  return along.y() > along.z() ? FileAxes::kYUp : FileAxes::kZUp;
}

namespace {

using body::Landmark;

/// Joints that can carry markers of which the set does not say where they sit: segments that have
/// markers it does know.
std::vector<int> Candidates(const body::Skeleton& skeleton, const body::Landmarks& landmarks,
                            const MarkerSet& set) {
  std::vector<int> carriers = {0};
  for (Landmark l :
       {Landmark::kChest, Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftElbow,
        Landmark::kRightElbow, Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftKnee,
        Landmark::kRightKnee, Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
    carriers.push_back(landmarks[l]);
  }
  for (Landmark l : {Landmark::kLeftWrist, Landmark::kRightWrist}) {
    carriers.push_back(skeleton.joint(landmarks[l]).parent);  // The forearm as it turns.
    if (!set.hand.empty()) carriers.push_back(landmarks[l]);
  }
  if (!set.head.empty()) carriers.push_back(landmarks[Landmark::kHead]);
  return carriers;
}

/// The joint that carries each marker the set knows; -1 for the others.
std::vector<int> KnownCarriers(const body::Skeleton& skeleton, const body::Landmarks& landmarks,
                               const MarkerTracks& tracks, const MarkerSet& set) {
  std::vector<int> known(tracks.names.size(), -1);
  for (int side = 0; side < 2; ++side) {
    const auto of = [&](Landmark left) { return landmarks[OfSide(left, side)]; };
    const int forearm = skeleton.joint(of(Landmark::kLeftWrist)).parent;
    const std::pair<std::string_view, int> fields[] = {
        {set.asis, 0},
        {set.psis, 0},
        {set.knee_lateral, of(Landmark::kLeftHip)},
        {set.knee_medial, of(Landmark::kLeftHip)},
        {set.ankle_lateral, of(Landmark::kLeftKnee)},
        {set.ankle_medial, of(Landmark::kLeftKnee)},
        {set.heel, of(Landmark::kLeftAnkle)},
        {set.toe, of(Landmark::kLeftAnkle)},
        {set.fifth_metatarsal, of(Landmark::kLeftAnkle)},
        {set.shoulder, of(Landmark::kLeftClavicle)},
        {set.elbow_lateral, of(Landmark::kLeftShoulder)},
        {set.elbow_medial, of(Landmark::kLeftShoulder)},
        {set.wrist_radius, forearm},
        {set.wrist_ulna, forearm},
        {set.hand, of(Landmark::kLeftWrist)},
        {set.cervicale, landmarks[Landmark::kChest]},
        {set.sternum, landmarks[Landmark::kChest]},
        {set.head, landmarks[Landmark::kHead]},
    };
    for (const auto& [field, joint] : fields) {
      for (const int marker : MarkersOf(tracks, set, field, side)) {
        known[static_cast<std::size_t>(marker)] = joint;
      }
    }
  }
  return known;
}

}  // namespace

MarkerCarriers FindCarriers(const body::Skeleton& skeleton, const body::Landmarks& landmarks,
                            const MarkerTracks& tracks, const MarkerSet& set) {
  return {Candidates(skeleton, landmarks, set), KnownCarriers(skeleton, landmarks, tracks, set)};
}

namespace {

using MaybePoint = std::optional<Eigen::Vector3d>;

// From a lateral marker's centre to the joint's, m: half the width of an adult's joint and the
// marker's own radius.
constexpr double kHalfKneeM = 0.055, kHalfAnkleM = 0.040, kHalfElbowM = 0.045, kHalfWristM = 0.0;

struct Markers {
  const MarkerTracks& tracks;
  const MarkerSet& set;
  Eigen::Index frame;

  /// Mean of the markers of a field; nothing where one of them was not seen.
  MaybePoint Mean(std::string_view field, int side) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto markers = MarkersOf(tracks, set, field, side);
    for (const int marker : markers) {
      sum += tracks.p[static_cast<std::size_t>(marker)].col(frame);
    }
    if (markers.empty() || !sum.allFinite()) return std::nullopt;
    return sum / static_cast<double>(markers.size());
  }
};

/// Harrington's regression, of the left (0) and right (1) hip. Pelvis: x ahead, y left, z up.
std::array<MaybePoint, 2> Hips(const Markers& markers) {
  const MaybePoint asis[2] = {markers.Mean(markers.set.asis, 0), markers.Mean(markers.set.asis, 1)};
  const MaybePoint psis[2] = {markers.Mean(markers.set.psis, 0), markers.Mean(markers.set.psis, 1)};
  if (!asis[0] || !asis[1] || !psis[0] || !psis[1]) return {};
  const Eigen::Vector3d front = (*asis[0] + *asis[1]) / 2, back = (*psis[0] + *psis[1]) / 2;
  const Eigen::Vector3d y = (*asis[0] - *asis[1]).normalized();
  const Eigen::Vector3d z = (front - back).cross(y).normalized();
  const Eigen::Vector3d x = y.cross(z);
  const double depth_m = (front - back).norm(), width_m = (*asis[0] - *asis[1]).norm();
  std::array<MaybePoint, 2> hips;
  for (int side = 0; side < 2; ++side) {
    hips[static_cast<std::size_t>(side)] = front + (-0.24 * depth_m - 0.0099) * x +
                                           (-0.30 * width_m - 0.0109) * z +
                                           (side == 0 ? 1 : -1) * (0.33 * width_m + 0.0073) * y;
  }
  return hips;
}

/// Midway between both markers, or from the lateral one inwards: square to the limb, along
/// `left_W`.
MaybePoint JointBetween(const MaybePoint& lateral, const MaybePoint& medial,
                        const MaybePoint& above, const Eigen::Vector3d& left_W, int side,
                        double half_width_m) {
  if (lateral && medial) return (*lateral + *medial) / 2;
  if (!lateral || !above) return std::nullopt;
  const Eigen::Vector3d limb = (*lateral - *above).normalized();
  const Eigen::Vector3d across = left_W - left_W.dot(limb) * limb;
  if (across.norm() < 0.1) return std::nullopt;
  return *lateral - (side == 0 ? 1 : -1) * half_width_m * across.normalized();
}

}  // namespace

Centres JointCentres(const MarkerTracks& tracks, const MarkerSet& set, Eigen::Index frame) {
  const Markers markers{tracks, set, frame};
  Centres centres;
  const auto at = [&centres](Landmark landmark) -> MaybePoint& {
    return centres[static_cast<std::size_t>(landmark)];
  };
  const auto hips = Hips(markers);
  const MaybePoint shoulders[2] = {markers.Mean(set.shoulder, 0), markers.Mean(set.shoulder, 1)};
  if (!hips[0] || !hips[1]) return centres;
  const Eigen::Vector3d middle = (*hips[0] + *hips[1]) / 2;
  at(Landmark::kHips) = middle;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  if (shoulders[0] && shoulders[1]) {
    up = ((*shoulders[0] + *shoulders[1]) / 2 - middle).normalized();
  }
  const Eigen::Vector3d left_W = (*hips[0] - *hips[1]).normalized();
  for (int side = 0; side < 2; ++side) {
    const auto here = [&](Landmark left) -> MaybePoint& { return at(OfSide(left, side)); };
    const auto mean = [&](std::string_view field) { return markers.Mean(field, side); };
    here(Landmark::kLeftHip) = hips[static_cast<std::size_t>(side)];
    here(Landmark::kLeftKnee) = JointBetween(mean(set.knee_lateral), mean(set.knee_medial),
                                             here(Landmark::kLeftHip), left_W, side, kHalfKneeM);
    here(Landmark::kLeftAnkle) = JointBetween(mean(set.ankle_lateral), mean(set.ankle_medial),
                                              here(Landmark::kLeftKnee), left_W, side, kHalfAnkleM);
    here(Landmark::kLeftToe) = mean(set.toe);
    if (shoulders[side]) {
      here(Landmark::kLeftShoulder) = *shoulders[side] - set.shoulder_over_joint_m * up;
    }
    here(Landmark::kLeftElbow) =
        JointBetween(mean(set.elbow_lateral), mean(set.elbow_medial), here(Landmark::kLeftShoulder),
                     left_W, side, kHalfElbowM);
    here(Landmark::kLeftWrist) =
        JointBetween(mean(set.wrist_radius), mean(set.wrist_ulna), here(Landmark::kLeftElbow),
                     left_W, side, kHalfWristM);
    here(Landmark::kLeftHandEnd) = mean(set.hand);
  }
  const MaybePoint cervicale = markers.Mean(set.cervicale, 0),
                   sternum = markers.Mean(set.sternum, 0);
  at(Landmark::kNeck) = cervicale;
  if (cervicale && sternum) at(Landmark::kNeck) = (*cervicale + *sternum) / 2;
  at(Landmark::kHead) = markers.Mean(set.head, 0);
  return centres;
}

}  // namespace footing::motion
