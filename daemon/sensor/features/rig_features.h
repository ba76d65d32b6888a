#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/sensor.h"
#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/device_features.h"
#include "daemon/sensor/features/grip.h"
#include "daemon/sensor/features/phase.h"
#include "daemon/sensor/features/together.h"

/// The five features of the gait paper, section 6, of all controllers of one rig: moving or not,
/// frequency, phase between left and right, amplitude, inclination.
namespace footing::features {

struct Member {
  std::uint32_t device = 0;
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
};

/// Samples in, features out; any set of controllers of one rig, as they come. The two hands make a
/// pair, and so do the two legs. A plain value of fixed size; copy it to try something out.
class RigFeatureExtractor {
 public:
  /// Members that are boards are a bug of the caller, and so are more than eight.
  RigFeatureExtractor(std::string rig, const std::vector<Member>& members,
                      const Config& config = {});

  /// Takes the sample by its device; a device outside the rig is ignored. Instants are
  /// sampled_ns; both the raw and the filtered force must be filled in (m/s², frame S).
  void AddSample(const stream::MotionSample& sample);

  /// Features as of the newest samples. Call once a tick (10 ms): what is held is held by the time
  /// between the samples, not by the number of calls. decoded_ns is left to the caller. Never NaN.
  stream::RigFeatures Compute(std::int64_t now_ns);

 private:
  struct Pair {
    std::size_t left = 0;
    std::size_t right = 0;
    Phase phase;
    std::int64_t computed_index = 0;
    double period_s = 0;    ///< That the two had in common last.
    double disagree_s = 0;  ///< How long they have had none.
    Together together;      ///< While no period shows their phase.
    PairGrip grip;
  };
  /// The period that the two share; 0 while they do not agree on one.
  double CommonPeriod(const stream::DeviceFeatures& left, const stream::DeviceFeatures& right,
                      double elapsed_s, Pair& pair) const;
  std::vector<Partner> Partners() const;  ///< By device.
  void AddPair(stream::DeviceRole left, stream::DeviceRole right);
  stream::PairFeatures ComputePair(Pair& pair, const std::vector<stream::DeviceFeatures>& devices);

  std::string rig_;
  Config config_;
  std::vector<DeviceFeatureExtractor> devices_;
  std::vector<Pair> pairs_;
};

}  // namespace footing::features
