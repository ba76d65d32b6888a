#include "common/virtual/motion/marker_carriers.h"

#include <string_view>
#include <utility>

namespace footing::motion {
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

}  // namespace footing::motion
