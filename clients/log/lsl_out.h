#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "clients/log/lsl_outlets.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "footing/v1/session.pb.h"

namespace footing::log_client {

/// The kinds of streams that can be offered, as --streams names them.
inline constexpr const char* kLslKinds[] = {"motion", "boards", "cop",      "features", "com",
                                            "pose",   "gait",   "contacts", "events"};

/// The data of one server as streams of LSL: one for each device, rig or character and kind, named
/// as in an export to XDF. A stream begins with the first sample of it; that of the events is there
/// from the start. What is not valid is NaN.
class LslStreams {
 public:
  /// Streams of `kinds` alone. `server` is the first part of the names, and `tick_hz` the rate of
  /// what comes with each tick.
  LslStreams(lsl::Outlets& outlets, std::set<std::string> kinds)
      : outlets_(outlets), kinds_(std::move(kinds)) {}

  void Begin(const std::string& server, double tick_hz);
  /// `offset_ns` is the server's clock minus ours.
  void Take(const v1::Tick& tick, std::int64_t offset_ns);

  /// Why a stream could not be offered; empty: all could.
  const std::string& problem() const { return problem_; }

 private:
  struct Device {
    std::string serial, name, rig, role;
    bool simulated = false;
    bool operator==(const Device&) const = default;
  };
  /// One board's last load, in W.
  struct Load {
    double time_s = -1e9;
    double total_n = 0;
    bool valid = false;
    double x_m = 0, y_m = 0;
  };
  using Notes = std::vector<std::pair<std::string, std::string>>;

  bool Wants(const char* kind) const { return kinds_.contains(kind); }
  double SecondsOf(std::int64_t server_ns) const {
    return 1e-9 * static_cast<double>(server_ns - offset_ns_);
  }

  void TakeStatus(const v1::DeviceStatusList& status);
  void TakeMotion(const v1::MotionSamples& motion);
  void TakeBoards(const v1::BoardSamples& boards);
  void TakeFeatures(const v1::FeatureFrame& features, double time_s);
  void TakeCharacter(const v1::Character& character, double time_s);
  void TakePose(const v1::Character& character, const v1::Skeleton& skeleton, double time_s);
  void TakeEvents(const v1::Events& events, double time_s);
  void TakeSetup(const v1::SetupState& setup, double time_s);

  /// The number of a stream that is there, or is made now.
  using Key = std::tuple<std::string, std::uint64_t>;
  std::optional<std::size_t> DeviceStream(const char* kind, const std::string& topic,
                                          const char* type, std::uint32_t device, double rate_hz,
                                          const std::vector<lsl::Channel>& channels,
                                          const char* frame);
  std::optional<std::size_t> Stream(const Key& key, const std::string& name,
                                    const std::string& source, const char* type, double rate_hz,
                                    const std::vector<lsl::Channel>& channels, const Notes& notes);
  void Push(std::optional<std::size_t> stream, double time_s, const std::vector<double>& values);
  void PushText(const char* name, std::uint64_t number, double time_s, const std::string& text);

  lsl::Outlets& outlets_;
  std::set<std::string> kinds_;
  std::string server_;
  double tick_hz_ = 0;
  std::int64_t offset_ns_ = 0;
  std::map<std::uint32_t, Device> devices_;
  std::map<std::string, v1::BoardLayout> layouts_;            ///< By rig.
  std::map<std::string, std::map<std::string, Load>> loads_;  ///< By rig and role.
  std::map<std::uint32_t, v1::Skeleton> skeletons_;
  std::map<std::uint32_t, std::string> phases_;   ///< By character.
  std::map<std::string, std::uint64_t> prompts_;  ///< Number of the last one, by rig.
  std::map<Key, std::optional<std::size_t>> streams_;
  std::map<std::string, std::size_t>
      by_source_;  ///< Streams of this server, which outlive its run.
  std::set<std::string> names_;
  std::string problem_;
};

/// Options of a program that offers streams.
struct LslOptions {
  std::vector<transport::Address> addresses;
  std::set<std::string> kinds;
  lsl::OutletsOptions outlets;
  double seconds = 0;  ///< 0: until SIGINT or SIGTERM.
};

/// Offers what the servers send until the time is up; then the counts of each stream. NoDevice
/// where no server was there.
Result<std::vector<lsl::OutletReport>> OfferLsl(const LslOptions& options);

}  // namespace footing::log_client
