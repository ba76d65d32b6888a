#include "daemon/sensor/service/service.h"

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <map>
#include <utility>

#include "common/clock/clock.h"
#include "common/log/log.h"
#include "common/service_manager/service_manager.h"
#include "common/transport/address.h"
#include "common/transport/server.h"
#include "common/units/time.h"
#include "common/wire/wire.h"
#include "daemon/sensor/devices/hid_source.h"
#include "daemon/sensor/devices/socket_source.h"
#include "daemon/sensor/service/answer.h"
#include "daemon/sensor/service/hub.h"
#include "daemon/sensor/service/publish.h"
#include "daemon/sensor/setup/calibration_store.h"
#include "daemon/sensor/setup/state_directory.h"

namespace footing::sensor {
namespace {

using devices::DeviceHandle;

/// The socket that the service manager passed under this name, or the user's own.
std::string OwnAddress(const std::string& name) {
  if (service_manager::PassedSocket(name) >= 0) return "fd:" + name;
  return transport::DefaultAddress(name, true).Text();
}

transport::ServerOptions MakeServerOptions(const Config& config, const std::string& version) {
  transport::ServerOptions options;
  options.server_id = "footingd";
  options.version = version;
  options.channels = Channels();
  options.tick_rate_hz = config.tick_rate_hz;
  options.capabilities = {"features", "boards",   "raw",    "rumble", "leds",
                          "assign",   "nunchuk",  "camera", "sphere", "setup",
                          "tare",     "mounting", "layout", "hands",  "contacts"};
  return options;
}

/// The configured state directory; none when nothing is to be kept.
setup::Storage StorageOf(setup::StateDirectory& directory, const Config& config) {
  return config.state_directory == "none" ? setup::Storage() : setup::StorageIn(directory);
}

}  // namespace

class Service::Implementation : public std::enable_shared_from_this<Service::Implementation> {
 public:
  Implementation(boost::asio::io_context& io, const Config& config, const std::string& version)
      : io_(io),
        config_(config),
        timer_(io),
        state_(setup::StatePath(config.state_directory),
               [](const std::string& line) { log::Warning(line); }),
        calibrations_(StorageOf(state_, config)),
        hub_(config,
             {[this](DeviceHandle device, const reports::OutputReport& report) {
                Send(device, report);
              },
              [](const std::string& line) { log::Info(line); }, [] { return clock::MonotonicNs(); },
              [this](DeviceHandle device, std::uint8_t id, std::size_t size) {
                RequestFeature(device, id, size);
              },
              [this](const std::string& serial) { return calibrations_.Load(serial); },
              [this](const std::string& serial, const std::vector<std::uint8_t>& bytes) {
                calibrations_.Save(serial, bytes);
              },
              StorageOf(state_, config)}),
        server_(
            io, MakeServerOptions(config, version),
            {[this](const transport::SessionInfo& session, const v1::Command& command) {
               return OnCommand(session, command);
             },
             [this](const transport::SessionInfo& session) { hub_.EndSession(session.session); }}) {
  }

  Result<void> Open() {
    auto listen = config_.listen;
    if (listen.empty()) listen = {OwnAddress("sensor")};
    for (const std::string& text : listen) {
      const auto address = transport::ParseAddress(text);
      if (!address) return address.error();
      if (const auto listening = server_.Listen(*address); !listening) return listening;
      listening_on_.push_back(server_.ListeningOn(listening_on_.size()).Text());
      log::Info("listening on " + listening_on_.back());
    }
    auto sources = config_.sources;
    if (sources.empty()) {
      sources = {"hid", "stream:" + OwnAddress("devices")};
    }
    for (const std::string& text : sources) {
      if (const auto opened = OpenSource(text); !opened) return opened;
    }
    return {};
  }

  void Start() {
    next_tick_ = std::chrono::steady_clock::now();
    WaitForTick();
  }

  void Stop(const std::string& reason) {
    hub_.StopMotors();
    timer_.cancel();
    for (const auto& source : sources_) source->Stop();
    server_.Stop(reason);
  }

  const std::vector<std::string>& listening_on() const { return listening_on_; }

 private:
  Result<void> OpenSource(const std::string& text) {
    const auto address = ParseSource(text);
    if (!address) return address.error();
    const std::size_t index = sources_.size();
    devices::SourceHandlers handlers;
    handlers.on_attach = [this, index](DeviceHandle device, const devices::DeviceIdentity& who) {
      source_of_[device] = index;
      hub_.OnAttach(device, who);
    };
    handlers.on_report = [this](DeviceHandle device, const devices::IncomingReport& report) {
      hub_.OnReport(device, report);
    };
    handlers.on_detach = [this](DeviceHandle device, const std::string& reason) {
      hub_.OnDetach(device, reason);
      source_of_.erase(device);
    };
    handlers.on_hands = [this](std::int64_t received_ns, const stream::HandFrame& frame) {
      hub_.OnHands(received_ns, frame);
    };
    handlers.on_reference = [this](std::int64_t received_ns, const stream::ReferenceFrame& frame) {
      hub_.OnReference(received_ns, frame);
    };
    handlers.on_contacts = [this](std::int64_t received_ns, const stream::ContactFrame& frame) {
      hub_.OnContacts(received_ns, frame);
    };
    handlers.on_trouble = [](const std::string& line) { log::Warning(line); };
    const auto new_handle = [this] { return ++last_handle_; };
    if (!*address) {
      sources_.push_back(std::make_unique<devices::HidSource>(io_, new_handle, handlers));
      // Without rights to any device simulated ones still work.
      if (const auto started = sources_.back()->Start(); !started) {
        log::Warning(started.error().message);
      }
      return {};
    }
    sources_.push_back(
        std::make_unique<devices::SocketSource>(io_, **address, new_handle, handlers));
    if (const auto started = sources_.back()->Start(); !started) return started;
    log::Info("simulated devices on " + (*address)->Text());
    return {};
  }

  void Send(DeviceHandle device, const reports::OutputReport& report) {
    const auto source = source_of_.find(device);
    if (source != source_of_.end()) sources_[source->second]->Send(device, report);
  }

  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
    const auto source = source_of_.find(device);
    if (source != source_of_.end()) sources_[source->second]->RequestFeature(device, id, size);
  }

  void WaitForTick() {
    const auto period = std::chrono::nanoseconds(PeriodNanoseconds(config_.tick_rate_hz));
    const auto now = std::chrono::steady_clock::now();
    next_tick_ += period;
    if (now - next_tick_ > 10 * period) next_tick_ = now;  // After a pause of the machine.
    timer_.expires_at(next_tick_);
    timer_.async_wait([weak = weak_from_this()](boost::system::error_code error) {
      const auto self = weak.lock();
      if (error || !self) return;
      const std::int64_t now_ns = clock::MonotonicNs();
      self->server_.Publish(now_ns, ToChannels(self->hub_.Tick(now_ns)));
      self->WaitForTick();
    });
  }

  v1::CommandResult OnCommand(const transport::SessionInfo& session, const v1::Command& command) {
    switch (command.action_case()) {
      case v1::Command::kSetRumble: {
        const v1::SetRumble& rumble = command.set_rumble();
        return Answer(command, hub_.SetRumble(session.session, rumble.device(), rumble.on(),
                                              rumble.lease_ms() * 1e-3));
      }
      case v1::Command::kSetLeds:
        return Answer(command, hub_.SetLeds(command.set_leds().device(),
                                            static_cast<std::uint8_t>(command.set_leds().leds())));
      case v1::Command::kAssignRole: {
        const v1::AssignRole& assign = command.assign_role();
        Binding binding = {assign.rig().empty() ? config_.default_rig : assign.rig(),
                           stream::DeviceRole::kUnspecified};
        if (v1::DeviceRole_IsValid(assign.role())) {
          binding.role = static_cast<stream::DeviceRole>(assign.role());
        }
        return Answer(command, hub_.AssignRole(assign.serial(), binding));
      }
      case v1::Command::kSetSphere:
        return Answer(command,
                      hub_.SetSphere(command.set_sphere().device(), command.set_sphere().rgb()));
      case v1::Command::kSetCamera:
        return Answer(command,
                      hub_.SetCamera(command.set_camera().device(), command.set_camera().on()));
      case v1::Command::kRequestDeviceStatus:
        return Answer(command, hub_.RequestDeviceStatus(command.request_device_status().device()));
      case v1::Command::kPutBack:
      case v1::Command::kPush:
      case v1::Command::kDirectGait:
      case v1::Command::kAppendSegment:
      case v1::Command::kCalibrateTPose:
      case v1::Command::kSetSubject:
      case v1::Command::kStartTrial:
      case v1::Command::kStopTrial:
      case v1::Command::kCorrectFailure:
      case v1::Command::kSetInterface:
      case v1::Command::kTakeLease:
      case v1::Command::kReleaseLease:
      case v1::Command::kSetGame:
        return Answer(command, UsageError("that is a command for footing-sim"));
      case v1::Command::kTare:
      case v1::Command::kSolveMounting:
      case v1::Command::kSetBoardLayout:
      case v1::Command::kRecordSetup:
        return OnSetupCommand(command);
      case v1::Command::ACTION_NOT_SET:
        return Answer(command, UsageError("the command has no action that footingd knows"));
    }
    return Answer(command, UsageError("the command has no action that footingd knows"));
  }

  v1::CommandResult OnSetupCommand(const v1::Command& command) {
    if (command.has_tare()) {
      const v1::Tare& tare = command.tare();
      return AnswerMeasured(command, hub_.Tare(tare.serial(), tare.window_s(), tare.clear()));
    }
    if (command.has_solve_mounting()) {
      const v1::SolveMounting& solve = command.solve_mounting();
      if (solve.clear()) return AnswerMeasured(command, hub_.ClearMounting(solve.serial()));
      return AnswerMeasured(
          command,
          hub_.SolveMounting(solve.serial(), {solve.still_from_ns(), solve.still_to_ns(),
                                              solve.steps_from_ns(), solve.steps_to_ns()}));
    }
    if (command.has_set_board_layout()) {
      return AnswerMeasured(
          command, hub_.SetBoardLayout(wire::FromProto(command.set_board_layout().layout())));
    }
    const v1::RecordSetup& record = command.record_setup();
    return Answer(command,
                  hub_.RecordSetup(record.rig(), wire::FromProto(record.item()), record.forget()));
  }

  boost::asio::io_context& io_;
  const Config config_;
  boost::asio::steady_timer timer_;
  std::chrono::steady_clock::time_point next_tick_;
  std::vector<std::unique_ptr<devices::DeviceSource>> sources_;
  std::map<DeviceHandle, std::size_t> source_of_;
  DeviceHandle last_handle_ = 0;
  setup::StateDirectory state_;
  setup::CalibrationStore calibrations_;
  Hub hub_;
  transport::Server server_;
  std::vector<std::string> listening_on_;
};

Service::Service(std::shared_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

Service::~Service() = default;

Result<std::unique_ptr<Service>> Service::Start(boost::asio::io_context& io, const Config& config,
                                                const std::string& version) {
  auto implementation = std::make_shared<Implementation>(io, config, version);
  if (const auto opened = implementation->Open(); !opened) return opened.error();
  implementation->Start();
  return std::unique_ptr<Service>(new Service(std::move(implementation)));
}

void Service::Stop(const std::string& reason) { implementation_->Stop(reason); }

std::vector<std::string> Service::listening_on() const { return implementation_->listening_on(); }

}  // namespace footing::sensor
