#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/stream/plan.h"
#include "common/stream/user_interface.h"
#include "common/virtual/people/driver.h"
#include "common/virtual/people/grip.h"
#include "common/virtual/people/person.h"
#include "common/virtual/people/range_acts.h"
#include "footing/v1/session.pb.h"

namespace footing::stream_client {

/// A synthetic user in real time: sees what footing-sim publishes of the character, its track and
/// its trial, and moves the devices of one interface. Its clock is that of its devices. Stands
/// still while it sees nothing.
class LiveUser {
 public:
  /// `turn_by` is what turns with the interface leg. A user with `acts` performs these again and
  /// again, whatever it sees.
  LiveUser(stream::UserInterface interface, stream::TurnSource turn_by, const users::Style& style,
           std::uint64_t seed, std::vector<users::Act> acts = {});

  void See(const v1::Tick& tick);
  /// What the devices feel at t_s since the motion began; after a new connection that is 0 again.
  const users::Felt& At(double t_s);

 private:
  users::Intention Want();

  /// Without a frame for this long the user sees nothing.
  static constexpr double kBlindS = 0.5;

  stream::Track track_;
  std::vector<users::Act> acts_;
  users::Driver driver_;
  users::Person person_;
  users::Observation seen_;
  users::Intention wanted_;
  double seen_s_ = -1e9;
  double time_s_ = 0;
  double before_s_ = 0;  ///< Of the connections before this one.
  double at_s_ = 0;
};

/// The devices of a synthetic user, and the user who moves them.
struct LiveUserPlan {
  Plan plan;
  std::shared_ptr<LiveUser> user;
};
/// Who the user is, as options have it.
struct LiveUserOptions {
  std::string interface = "wrist";
  std::string turn_by = "head";
  std::optional<double> grip_deg = {};  ///< None: drawn with the style.
  std::string grip_way = "mirrored";
  users::StyleWish style = {};
  bool ranges = false;  ///< Performs the motions of `footing-study ranges`.
};
/// A usage error lists what there is. `style_seed` is that of the user, common.seed that of the
/// devices.
Result<LiveUserPlan> PlanLiveUser(const LiveUserOptions& options, const Common& common,
                                  std::uint64_t style_seed);

}  // namespace footing::stream_client
