#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/recording/run_clock.h"
#include "common/recording/tables.h"
#include "footing/v1/session.pb.h"

namespace footing::bids {

/// The samples of devices, a table for each of what they are: a Wiimote and its Nunchuk have one
/// each, and so has each hand that a tracker sees. They are named by their roles, of another rig
/// than "main" with its name before; never by their serials. A device without a role is named by
/// its kind and its number in the recording.
class DeviceTables {
 public:
  /// `with_role` leaves out devices that have no role.
  explicit DeviceTables(bool with_role) : with_role_(with_role) {}

  /// What comes from now on is of this start of a server, which gives devices its own numbers.
  /// Samples of before the run are left out.
  void Start(const RunClock& clock);
  void Add(const v1::Tick& tick);

  const std::map<std::string, MotionTable>& tables() const { return tables_; }

 private:
  struct Device {
    std::string point;
    std::string kind;
  };

  /// Null: a device that is left out, or a sample of before the run. Sets `point_` and `time_s_`:
  /// of the sample, or of its tick where it does not say.
  MotionTable* Find(std::uint32_t device, std::int64_t sampled_ns, const std::string& part);
  MotionTable* Find(const Device& device, std::int64_t sampled_ns, const std::string& part);
  void AddStatus(const v1::DeviceStatus& one);
  void AddMotion(const v1::MotionSample& one);
  void AddBoard(const v1::BoardSample& one);
  void AddStick(const v1::NunchukSample& one);
  void AddHand(const v1::HandSample& one);

  bool with_role_;
  RunClock clock_;
  std::map<std::string, MotionTable> tables_;
  std::map<std::uint32_t, Device> devices_;
  std::int64_t tick_ns_ = 0;
  double time_s_ = 0;
  std::string point_;
};

}  // namespace footing::bids
