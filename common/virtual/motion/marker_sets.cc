#include "common/virtual/motion/marker_sets.h"

#include <array>

#include "common/base/joined.h"
#include "common/base/lines.h"

namespace footing::motion {
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
    {.name = "cmu41",  // Of the CMU database: waist markers front and back.
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

/// What of the necessary fields is not there; empty when all is.
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

/// What the file has, and what the set that is nearest to it would still need.
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

std::span<const MarkerSet> MarkerSets() { return kSets; }

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

}  // namespace footing::motion
