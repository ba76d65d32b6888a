#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/identity.h"

namespace footing::stream_client {

/// One report between a recorded device and its host, seconds since the replay's start.
struct RecordedReport {
  double time_s = 0;
  virtual_devices::Report bytes;
  bool to_device = false;
  bool feature = false;
};

/// A device of a recording, from its attachment to its loss: its data come at their recorded times;
/// what the host asks of it is answered as the recorded device answered the same request.
///
/// A request that came several times has its answers in their order, the last one again and again.
/// A read that was never recorded is refused as a device refuses what it does not have; other
/// requests without a recorded answer have none.
class RecordedDevice {
 public:
  /// `reports` in the order of their times. `stored_calibration` is what the recorded host knew of
  /// a PS Move without asking it; empty: nothing.
  RecordedDevice(virtual_devices::Identity identity, double attaches_s, double detaches_s,
                 const std::vector<RecordedReport>& reports,
                 const std::vector<std::uint8_t>& stored_calibration);

  const virtual_devices::Identity& identity() const { return identity_; }
  double attaches_s() const { return attaches_s_; }
  double detaches_s() const { return detaches_s_; }
  /// The host's questions were recorded: it can be set up again as it was.
  bool has_handshake() const { return !answers_.empty() || !features_.empty(); }

  std::vector<virtual_devices::Report> HandleOutput(std::int64_t now_ns,
                                                    std::span<const std::uint8_t> output);
  /// A feature report cut to `size`; empty when the recorded device refused or was not asked.
  virtual_devices::Report Feature(std::uint8_t id, std::size_t size);

  /// The time of the next data; nothing after the last.
  std::optional<double> NextTime() const;
  /// The data that comes next; NextTime() has a value.
  virtual_devices::Report Take();

 private:
  using Answer = std::vector<virtual_devices::Report>;

  void Learn(const std::vector<RecordedReport>& reports);

  virtual_devices::Identity identity_;
  double attaches_s_;
  double detaches_s_;
  std::vector<RecordedReport> data_;
  std::size_t next_ = 0;
  std::map<virtual_devices::Report, std::deque<Answer>> answers_;  ///< By request.
  std::map<std::uint8_t, std::deque<virtual_devices::Report>> features_;
};

}  // namespace footing::stream_client
