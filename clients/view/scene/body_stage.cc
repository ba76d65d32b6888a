#include "clients/view/scene/body_stage.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/anatomy.h"
#include "clients/view/scene/boards.h"
#include "clients/view/scene/person.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr std::int64_t kReferenceStaleNs = 1'000'000'000;

Anatomy AnatomyOf(const Model& model, std::uint32_t character) {
  for (const stream::Skeleton& skeleton : model.skeletons) {
    if (skeleton.character == character) return FindAnatomy(skeleton);
  }
  return {};
}

std::vector<Eigen::Vector3d> PlacesOf(const CharacterPose& pose) {
  std::vector<Eigen::Vector3d> p_m;
  for (const stream::LinkPose& link : pose.links) p_m.push_back(link.position_m);
  return p_m;
}

void AddReference(const Model& model, const Anatomy& anatomy, double lag_s, std::int64_t now_ns,
                  bool beside, Picture& picture) {
  const ReferencePose* reference = ReferenceAt(model, now_ns - SecondsToNanoseconds(lag_s));
  if (reference == nullptr) return;
  std::vector<Eigen::Vector3d> p_m = reference->positions_m;
  if (beside) {
    for (Eigen::Vector3d& p : p_m) p += kBesideM;
  }
  const PersonLook look = PlainLook(Rgb(0xffc861));
  if (Fits(anatomy, reference->parents)) {
    AddPerson(anatomy, p_m, {}, look, picture.ghosts);
  } else {
    AddLimbs(reference->parents, {}, p_m, look.shirt, picture.ghosts);
  }
}

/// Soft darkness under the shoes, on the boards.
void AddSoleShadows(const Anatomy& anatomy, const std::vector<Eigen::Vector3d>& p_m,
                    Picture& picture) {
  if (!anatomy.person) return;
  using body::Landmark;
  for (const auto& [ankle, toe] : {std::pair(Landmark::kLeftAnkle, Landmark::kLeftToe),
                                   std::pair(Landmark::kRightAnkle, Landmark::kRightToe)}) {
    const int a = anatomy.landmarks[ankle], b = anatomy.landmarks[toe];
    if (a < 0 || b < 0 || std::max(a, b) >= static_cast<int>(p_m.size())) continue;
    const Eigen::Vector3d& from_m = p_m[static_cast<std::size_t>(a)];
    const Eigen::Vector3d& to_m = p_m[static_cast<std::size_t>(b)];
    if (to_m.z() > 0.15) continue;
    const Eigen::Vector3d middle_m = 0.35 * from_m + 0.65 * to_m;
    const double yaw_rad = std::atan2(to_m.y() - from_m.y(), to_m.x() - from_m.x());
    picture.clear.AddDisc(
        {static_cast<float>(middle_m.x()), static_cast<float>(middle_m.y()), 0.0015f},
        {0.145f, 0.056f}, static_cast<float>(yaw_rad), Rgb(0x101418));
  }
}

}  // namespace

bool HasReference(const Model& model, std::int64_t now_ns) {
  return !model.observed.references.empty() &&
         now_ns - model.observed.references.back().received_ns < kReferenceStaleNs;
}

void AddBody(const Model& model, const CharacterPose& pose, const ComTrail& trail,
             std::int64_t now_ns, const StageOptions& options, Picture& picture) {
  const Anatomy anatomy = AnatomyOf(model, pose.character);
  const std::vector<Eigen::Vector3d> p_m = PlacesOf(pose);
  const BodyState& body = *pose.body;
  AddBoards(BoardsOf(model, pose.rig, now_ns), picture.figures);
  if (body.calibrated) {
    AddPerson(anatomy, p_m, body.link_sd_m, MannequinLook(), picture.figures);
    AddSoleShadows(anatomy, p_m, picture);
  } else {
    AddPerson(anatomy, p_m, {}, PlainLook(Rgb(0x8fd6ff)), picture.ghosts);
  }
  if (HasReference(model, now_ns)) {
    const bool beside = !options.overlay_reference;
    AddReference(model, anatomy, body.lag_s, now_ns, beside, picture);
  }
  BodySigns signs;
  AddBodySigns(pose, trail, signs);
  AddHandSigns(model.observed.hands, pose.rig, now_ns, signs);
  picture.signs = std::move(signs.solid);
  const PartList& clear = signs.clear;
  picture.clear.balls.insert(picture.clear.balls.end(), clear.balls.begin(), clear.balls.end());
  picture.labels = std::move(signs.labels);
}

}  // namespace footing::scene
