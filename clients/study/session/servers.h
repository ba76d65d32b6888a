#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "clients/study/session/active_time.h"
#include "clients/study/session/console.h"
#include "common/result/result.h"
#include "common/stream/device.h"
#include "common/stream/trial.h"
#include "common/transport/address.h"
#include "footing/v1/session.pb.h"

namespace footing::study {

/// Connections to footingd, for the health of the devices, and to footing-sim, for trials.
class Servers {
 public:
  /// NoDevice when one of them is not there within a few seconds. `active` goes on counting as long
  /// as the connection lasts.
  static Result<std::unique_ptr<Servers>> Open(Console& console, const transport::Address& sensor,
                                               const transport::Address& simulation,
                                               ActiveTime& active);
  ~Servers();
  Servers(const Servers&) = delete;
  Servers& operator=(const Servers&) = delete;

  const std::vector<stream::DeviceStatus>& devices() const;
  /// Of the first character; without an id before the first trial.
  const stream::TrialState& trial() const;
  bool live() const;
  /// How the connections stand, for a person.
  std::string Links() const;

  /// Called while the console waits.
  void set_on_trial(std::function<void(const stream::TrialState&)> on_trial);
  void set_on_event(std::function<void(const v1::Event&)> on_event);

  /// Sends a command to footing-sim and waits for the answer; a refusal is a failure with its text.
  Result<void> Call(v1::Command command);

 private:
  class Implementation;
  explicit Servers(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::study
