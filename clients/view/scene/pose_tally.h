#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "clients/view/scene/anatomy.h"
#include "clients/view/scene/body_state.h"
#include "clients/view/scene/update.h"

namespace footing::scene {

/// What a run has seen of a reconstructed body, and how far it was from what the simulated person's
/// body really did. Each pose is held against the reference that was sampled nearest to when the
/// pose is of (its publication less its lag), so all latencies count as errors.
class PoseTally {
 public:
  /// The first character of a frame that was published at `host_ns` (the viewer's clock).
  void Add(const CharacterPose& pose, const Anatomy& anatomy, std::int64_t host_ns,
           const std::deque<ReferencePose>& references);

  bool any() const { return frames_ > 0; }
  bool calibrated() const { return last_.calibrated; }
  /// Frames with a T-pose taken, and how often one was taken.
  std::uint64_t calibrated_frames() const { return calibrated_frames_; }
  std::uint64_t calibrations() const { return calibrations_; }
  std::uint32_t resets() const { return last_.resets; }
  double mass_kg() const { return last_.mass_kg; }
  const std::string& hands_source() const { return last_.hands_source; }
  const std::string& contact_source() const { return last_.contact_source; }
  /// Frames that were compared; the means below are over them, cm, over those that are not valid,
  /// too. Joints are the landmarks of a person without the tips of hands and toes.
  std::uint64_t compared() const { return compared_; }
  std::uint64_t invalid() const { return invalid_; }  ///< Of the frames compared.
  double mpjpe_cm() const { return Mean(all_cm_); }
  /// Of the joints against the hips.
  double mpjpe_root_relative_cm() const { return Mean(relative_cm_); }
  double wrists_cm() const { return Mean(wrists_cm_); }
  double ankles_cm() const { return Mean(ankles_cm_); }

 private:
  double Mean(double sum) const {
    return compared_ == 0 ? 0 : sum / static_cast<double>(compared_);
  }
  void Compare(const CharacterPose& pose, const Anatomy& anatomy, const ReferencePose& reference);

  std::uint64_t frames_ = 0, calibrated_frames_ = 0, calibrations_ = 0, compared_ = 0, invalid_ = 0;
  BodyState last_;
  double all_cm_ = 0, relative_cm_ = 0, wrists_cm_ = 0, ankles_cm_ = 0;
};

}  // namespace footing::scene
