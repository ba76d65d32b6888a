#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/net/client.h"
#include "tests/device_faults/model.h"
#include "tests/device_faults/node.h"
#include "tests/device_faults/program.h"
#include "tests/device_faults/seen.h"
#include "tests/device_faults/testbed.h"

namespace footing::device_faults {

/// A model plugged into the bench as /dev/hidrawN. The faults that are not the model's own are
/// made here, between model and socket.
class Device {
 public:
  struct Output {
    std::int64_t written_ns = 0;
    Report report;
  };

  Device(boost::asio::io_context& io, Testbed& testbed, const std::string& folder, int number,
         std::shared_ptr<Model> model);
  ~Device();

  Model& model() { return *model_; }
  const std::string& serial() const { return model_->identity().serial; }
  int number() const { return number_; }
  Node& node() { return node_; }
  /// Everything that was written to it.
  const std::vector<Output>& outputs() const { return outputs_; }
  /// How many outputs have this id.
  std::size_t Outputs(std::uint8_t id) const;

  void Send(const Report& report);  ///< As if the device sent it: through `outgoing`.
  void SendRaw(const Report& report) { node_.Send(report); }
  void SampleNow();

  /// Called for each report that the device sends; what it returns is sent instead.
  std::function<std::vector<Report>(const Report&)> outgoing;
  /// Called for each report that is written to it; true swallows it.
  std::function<bool(std::span<const std::uint8_t>)> incoming;
  bool sampling = true;  ///< False: no data reports; it still answers.

 private:
  friend class Bench;
  void Tick();
  void Answer(std::span<const std::uint8_t> report);

  Testbed& testbed_;
  int number_;
  std::shared_ptr<Model> model_;
  Node node_;
  boost::asio::steady_timer timer_;
  std::vector<Output> outputs_;
  std::shared_ptr<int> alive_ = std::make_shared<int>();
};

/// Longest wait for an event whose time does not matter: no load of the machine explains more.
constexpr double kPatienceS = 30;

struct PlugOptions {
  int number = -1;  ///< Number of the hidraw node; -1: the next free one.
  std::string driver = "wiimote";
  bool identified = true;        ///< False: udev has neither name nor serial yet.
  std::int32_t open_errno = 0;   ///< Not 0: opening fails with it.
  std::int32_t write_errno = 0;  ///< Not 0: every write fails with it.
};

/// One machine: its devices, the shipped footingd and a client, all on one thread and in a folder
/// of its own. Times out rather than hangs.
class Bench {
 public:
  Bench();
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  Device& Plug(std::shared_ptr<Model> model, const PlugOptions& options = {});
  /// The node ends, udev says so.
  void Unplug(Device& device);
  /// Ends what a test does between models and sockets: it may be about its own variables.
  void EndFaults();
  Testbed& testbed() { return testbed_; }

  /// Starts footingd and the client, and waits until the two are connected.
  bool Start(const std::vector<std::string>& arguments = {});
  /// SIGTERM, then the exit status of waitpid(2); -1 when it does not end within 10 s.
  int Stop();
  /// Starts footingd anew with other arguments after Stop() or its death.
  bool Restart(const std::vector<std::string>& arguments = {});
  Program& footingd() { return *footingd_; }
  /// The client's connection alone.
  bool Connect();
  void Disconnect() { client_.reset(); }
  /// Another program with the same devices.
  std::unique_ptr<Program> Run(const std::vector<std::string>& command, const std::string& name);
  std::map<std::string, std::string> Environment() const;

  /// Lets time pass.
  void Run(double seconds);
  /// Lets time pass until it holds; false after the timeout.
  bool Until(const std::function<bool()>& holds, double timeout_s = kPatienceS);
  /// The same, with a limit on how long footingd may take: only time counts in which it published
  /// and this process, which is the devices, took the ticks at once. What stands still, on either
  /// side, is the machine's load. No longer than kPatienceS in all.
  bool Within(double seconds, const std::function<bool()>& holds);
  bool UntilLive(const Device& device, double timeout_s = kPatienceS);
  bool UntilState(const std::string& serial, v1::DeviceState state, double timeout_s = kPatienceS);
  /// So many more motion and board samples of the device.
  bool UntilSamples(const Device& device, std::size_t more, double timeout_s = kPatienceS);

  v1::CommandResult Send(v1::Command command);

  Seen& seen() { return seen_; }
  const std::string& folder() const { return folder_; }
  std::string Address() const { return "unix:" + folder_ + "/sensor.sock"; }
  boost::asio::io_context& io() { return io_; }
  std::string Log() const;
  std::size_t LogLines(const std::string& containing) const;
  /// Gaps that the client missed; not what footingd left out of its rhythm.
  const std::vector<v1::Gap>& gaps() const { return gaps_; }
  /// The resident memory of footingd.
  std::int64_t MemoryBytes() const;
  /// How many descriptors footingd has open.
  std::size_t Descriptors() const;
  std::size_t Samples(const Device& device) const;
  bool IsIn(const std::string& serial, v1::DeviceState state) const;
  /// Live, and samples of it have come since the last Forget().
  bool IsLive(const Device& device) const;

 private:
  std::string folder_;
  boost::asio::io_context io_;
  Testbed testbed_;
  std::vector<std::unique_ptr<Device>> devices_;
  int next_number_ = 0;
  std::unique_ptr<Program> footingd_;
  std::unique_ptr<transport::Client> client_;
  transport::LinkState link_ = transport::LinkState::kConnecting;
  void CountUndisturbed(const v1::Tick& tick);

  Seen seen_;
  std::vector<v1::Gap> gaps_;
  std::int64_t undisturbed_ns_ = 0;  ///< See Within().
  std::int64_t last_tick_ns_ = 0;
};

}  // namespace footing::device_faults
