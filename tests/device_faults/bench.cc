#include "tests/device_faults/bench.h"

#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "common/net/address.h"
#include "common/runtime/clock.h"

namespace footing::device_faults {
namespace {

const std::string kPrograms = FOOTING_BINARY_DIR "/bin/";
constexpr double kEndS = 10;  // On a machine that does much else; Fault62 has the second it takes.
const std::string kShim = FOOTING_BINARY_DIR "/tests/libfooting_hidraw_shim.so";

/// Where umockdev has its tree too; see main.cc.
std::string MakeFolder() {
  const char* parent = getenv("TMPDIR");
  std::string name = std::string(parent == nullptr ? "/tmp" : parent) + "/footing-bench-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("bench: cannot make a folder");
  return name;
}

}  // namespace

Bench::Bench() : folder_(MakeFolder()) {}

Bench::~Bench() {
  client_.reset();
  footingd_.reset();
  devices_.clear();
  io_.restart();
  io_.poll();
  std::filesystem::remove_all(folder_);
}

std::map<std::string, std::string> Bench::Environment() const {
  return {{"LD_PRELOAD", kShim + ":libumockdev-preload.so.0"},
          {"FOOTING_BENCH_DIR", folder_},
          {"ASAN_OPTIONS", "verify_asan_link_order=0"},
          {"XDG_RUNTIME_DIR", folder_},
          {"XDG_STATE_HOME", folder_ + "/state"},
          {"HOME", folder_}};
}

Device& Bench::Plug(std::shared_ptr<Model> model, const PlugOptions& options) {
  const int number = options.number < 0 ? next_number_ : options.number;
  next_number_ = std::max(next_number_, number + 1);
  const virtual_devices::Identity identity = model->identity();
  devices_.push_back(std::make_unique<Device>(io_, testbed_, folder_, number, std::move(model)));
  devices_.back()->node().page().open_errno = options.open_errno;
  devices_.back()->node().page().write_errno = options.write_errno;
  devices_.back()->node().page().write_faults = options.write_errno != 0 ? 1 << 30 : 0;
  testbed_.Add(number, identity, options.driver, options.identified);
  return *devices_.back();
}

void Bench::Unplug(Device& device) {
  const int number = device.number();
  const virtual_devices::Identity identity = device.model().identity();
  std::erase_if(devices_, [&device](const auto& one) { return one.get() == &device; });
  testbed_.Remove(number, identity);
}

void Bench::EndFaults() {
  for (const auto& device : devices_) {
    device->incoming = nullptr;
    device->outgoing = nullptr;
    device->node().page().write_blocks = 0;
  }
}

bool Bench::Start(const std::vector<std::string>& arguments) { return Restart(arguments); }

bool Bench::Restart(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {kPrograms + "footingd", "--listen", Address(), "--source",
                                      "hid"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  client_.reset();
  footingd_ = std::make_unique<Program>(command, Environment(), folder_ + "/footingd.log");
  return Connect();
}

bool Bench::Connect() {
  transport::ClientOptions options;
  options.address.path = folder_ + "/sensor.sock";
  options.client_name = "bench";
  options.role = v1::ROLE_ADMIN;
  options.backoff_min_s = 0.01;
  options.backoff_max_s = 0.05;
  options.queue_ticks = 500;
  transport::ClientHandlers handlers;
  handlers.on_tick = [this](const v1::Tick& tick) {
    CountUndisturbed(tick);
    seen_.Take(tick);
  };
  // Ticks that footingd left out because the machine did not let it run are nobody's fault here.
  handlers.on_gap = [this](const v1::Gap& gap) {
    if (gap.reason() != v1::Gap::REASON_UNSPECIFIED) gaps_.push_back(gap);
  };
  handlers.on_state = [this](transport::LinkState state, const std::string&) { link_ = state; };
  link_ = transport::LinkState::kConnecting;
  client_ = std::make_unique<transport::Client>(io_, std::move(options), std::move(handlers));
  client_->Start();
  return Until([this] { return link_ == transport::LinkState::kLive || footingd_->Ended(); }) &&
         !footingd_->Ended();
}

int Bench::Stop() {
  if (!footingd_) return 0;
  footingd_->Signal(SIGCONT);
  footingd_->Signal(SIGTERM);
  if (!Until([this] { return footingd_->Ended().has_value(); }, kEndS)) return -1;
  return *footingd_->Ended();
}

std::unique_ptr<Program> Bench::Run(const std::vector<std::string>& command,
                                    const std::string& name) {
  std::vector<std::string> whole = command;
  whole[0] = kPrograms + whole[0];
  return std::make_unique<Program>(whole, Environment(), folder_ + "/" + name + ".log");
}

void Bench::Run(double seconds) {
  Until([] { return false; }, seconds);
}

bool Bench::Until(const std::function<bool()>& holds, double timeout_s) {
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::nanoseconds(static_cast<std::int64_t>(timeout_s * 1e9));
  io_.restart();
  while (!holds()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    io_.run_one_for(std::chrono::milliseconds(1));
    if (io_.stopped()) io_.restart();
  }
  return true;
}

void Bench::CountUndisturbed(const v1::Tick& tick) {
  constexpr std::int64_t kLatestNs = 50'000'000, kLongestStepNs = 20'000'000;
  if (tick.snapshot()) return;
  const std::int64_t step_ns = tick.host_ns() - std::exchange(last_tick_ns_, tick.host_ns());
  if (clock::MonotonicNs() - tick.host_ns() > kLatestNs) return;
  undisturbed_ns_ += std::clamp<std::int64_t>(step_ns, 0, kLongestStepNs);
}

bool Bench::Within(double seconds, const std::function<bool()>& holds) {
  const std::int64_t end_ns = undisturbed_ns_ + static_cast<std::int64_t>(seconds * 1e9);
  return Until([&] { return holds() || undisturbed_ns_ >= end_ns; }) && holds();
}

bool Bench::IsIn(const std::string& serial, v1::DeviceState state) const {
  const v1::DeviceStatus* status = seen_.Status(serial);
  return status != nullptr && status->state() == state;
}

bool Bench::IsLive(const Device& device) const {
  return IsIn(device.serial(), v1::DEVICE_STATE_LIVE) && Samples(device) > 0;
}

bool Bench::UntilState(const std::string& serial, v1::DeviceState state, double timeout_s) {
  return Until([&] { return IsIn(serial, state); }, timeout_s);
}

bool Bench::UntilLive(const Device& device, double timeout_s) {
  return UntilState(device.serial(), v1::DEVICE_STATE_LIVE, timeout_s) &&
         UntilSamples(device, 1, timeout_s);
}

std::size_t Bench::Samples(const Device& device) const {
  return seen_.Motion(device.serial()).size() + seen_.Boards(device.serial()).size();
}

bool Bench::UntilSamples(const Device& device, std::size_t more, double timeout_s) {
  const std::size_t wanted = Samples(device) + more;
  return Until([&] { return Samples(device) >= wanted; }, timeout_s);
}

v1::CommandResult Bench::Send(v1::Command command) {
  v1::CommandResult result;
  bool answered = false;
  client_->Send(std::move(command), [&](const v1::CommandResult& answer) {
    result = answer;
    answered = true;
  });
  Until([&] { return answered; });
  return result;
}

std::string Bench::Log() const { return footingd_ ? footingd_->Output() : ""; }

std::size_t Bench::LogLines(const std::string& containing) const {
  std::istringstream lines(Log());
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(containing) != std::string::npos) ++count;
  }
  return count;
}

std::size_t Bench::Descriptors() const {
  const std::filesystem::directory_iterator list("/proc/" + std::to_string(footingd_->pid()) +
                                                 "/fd");
  return static_cast<std::size_t>(std::distance(begin(list), end(list)));
}

std::int64_t Bench::MemoryBytes() const {
  std::ifstream file("/proc/" + std::to_string(footingd_->pid()) + "/statm");
  std::int64_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace footing::device_faults
