#include "daemon/sensor/service/service.h"

#include <chrono>
#include <map>
#include <optional>
#include <utility>

#include "common/base/units.h"
#include "common/net/address.h"
#include "common/net/discovery.h"
#include "common/net/lease.h"
#include "common/net/monitoring.h"
#include "common/net/server.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"
#include "daemon/sensor/devices/hid_source.h"
#include "daemon/sensor/devices/socket_source.h"
#include "daemon/sensor/service/commands.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/hub.h"
#include "daemon/sensor/setup/setup_store.h"
#include "daemon/sensor/setup/state_directory.h"

namespace footing::sensor {
namespace {

using devices::DeviceHandle;

/// Late ticks are made up for up to this many; more are left out.
constexpr int kMostTicksBehind = 10;

/// The configured state directory; none when nothing is to be kept.
setup::Storage StorageOf(setup::StateDirectory& directory, setup::DiskWriter& disk,
                         const Config& config) {
  return config.state_directory == "none" ? setup::Storage() : setup::StorageIn(directory, disk);
}

}  // namespace

class Service::Implementation : public std::enable_shared_from_this<Service::Implementation> {
 public:
  Implementation(boost::asio::io_context& io, const Config& config, const std::string& version,
                 const transport::ServerOptions& with_access)
      : io_(io),
        config_(config),
        timer_(io),
        state_(setup::StatePath(config.state_directory),
               [](const std::string& line) { log::Warning(line); }),
        disk_(
            io,
            [this](const std::string& name, const std::string& content) {
              return state_.Write(name, content);
            },
            [this](const std::string& problem) { state_.SayWritten(problem); }),
        calibrations_(StorageOf(state_, disk_, config)),
        hub_(config,
             {[this](DeviceHandle device, const reports::OutputReport& report) {
                Send(device, report);
              },
              [this](const LogLine& line) { changes_.Say(line, clock::MonotonicNs()); },
              [] { return clock::MonotonicNs(); },
              [this](DeviceHandle device, std::uint8_t id, std::size_t size) {
                RequestFeature(device, id, size);
              },
              [this](const std::string& serial) { return calibrations_.Load(serial); },
              [this](const std::string& serial, const std::vector<std::uint8_t>& bytes) {
                calibrations_.Save(serial, bytes);
              },
              StorageOf(state_, disk_, config),
              [this](DeviceHandle device, const std::string& why) { Refuse(device, why); }}),
        server_(io, MakeServerOptions(config, version, with_access),
                {[this](const transport::SessionInfo& session, const v1::Command& command) {
                   return OnCommand(session, command);
                 },
                 [this](const transport::SessionInfo& session) {
                   hub_.EndSession(session.session);
                   lease_.EndSession(session.session);
                   if (session_devices_ != nullptr) session_devices_->EndSession(session.session);
                 },
                 LogOverload, DeviceHandler(config)}),
        monitor_(server_, config.tick_rate_hz, {"footingd", version}) {}

  Result<void> Open() {
    auto listen = SessionAddresses(config_);
    if (config_.listen.empty()) listen.insert(listen.begin(), OwnAddress("sensor"));
    for (const std::string& text : listen) {
      const auto address = transport::ParseAddress(text);
      if (!address) return address.error();
      if (const auto listening = server_.Listen(*address); !listening) return listening;
      listening_on_.push_back(server_.ListeningOn(listening_on_.size()).Text());
      const bool tls = listening_on_.back().starts_with("tls:");
      log::Info("listening on " + listening_on_.back() +
                (tls ? ", certificate " + server_.fingerprint() : ""));
    }
    auto sources = config_.sources;
    if (sources.empty()) sources = {"hid", "stream:" + OwnAddress("devices")};
    for (const std::string& text : sources) {
      if (const auto opened = OpenSource(text); !opened) return opened;
    }
    const std::string& name = config_.access.advertise;
    advertiser_.emplace(io_, discovery::ServicesOf(server_, listen.size(), name, "footingd"));
    return monitor_.Serve(io_, config_.metrics);
  }

  void Start() {
    next_tick_ = timer::Now();
    WaitForTick();
    if (config_.access.insecure_lan) lan_warning_ = transport::WarnOfInsecureLan(io_);
  }

  Result<void> Reload(const Config& wanted) {
    const auto changed_files = wanted.access.Reapply(server_);
    if (!changed_files) return changed_files.error();
    config_ = Reloaded(config_, wanted, *changed_files, log::Info);
    hub_.Reload(config_);
    server_.SetLimits(config_.sessions);
    return {};
  }

  void Stop(const std::string& reason, std::function<void()> done) {
    hub_.StopMotors();
    timer_.cancel();
    lan_warning_.reset();
    for (const auto& source : sources_) source->Stop();
    monitor_.Stop();
    advertiser_.reset();
    server_.Drain(reason, std::move(done));
  }

  std::string Stuck() const {
    for (const auto& source : sources_) {
      if (std::string what = source->Stuck(); !what.empty()) return what;
    }
    return "";
  }

  const std::vector<std::string>& listening_on() const { return listening_on_; }

 private:
  using OnDevice = decltype(transport::ServerHandlers::on_device);

  OnDevice DeviceHandler(const Config& config) {
    if (SessionSources(config).empty()) return nullptr;
    return [this](const transport::SessionInfo& session, std::int64_t received_ns,
                  const v1::DeviceEnvelope& message) {
      session_devices_->Take(session.session, received_ns, message);
    };
  }

  devices::SourceHandlers HandlersOf(std::size_t index) {
    devices::SourceHandlers handlers;
    handlers.on_attach = [this, index](DeviceHandle device, const devices::DeviceIdentity& who) {
      source_of_[device] = index;
      std::string why_not = hub_.OnAttach(device, who);
      if (!why_not.empty()) source_of_.erase(device);
      return why_not;
    };
    handlers.on_report = [this](DeviceHandle device, const devices::IncomingReport& report) {
      hub_.OnReport(device, report);
    };
    handlers.on_detach = [this](DeviceHandle device, const std::string& reason) {
      hub_.OnDetach(device, reason);
      source_of_.erase(device);
    };
    handlers.on_hands = [this](std::int64_t received_ns, const stream::HandFrame& frame) {
      hub_.trackers().OnHands(received_ns, frame);
    };
    handlers.on_reference = [this](std::int64_t received_ns, const stream::ReferenceFrame& frame) {
      hub_.trackers().OnReference(received_ns, frame);
    };
    handlers.on_contacts = [this](std::int64_t received_ns, const stream::ContactFrame& frame) {
      hub_.trackers().OnContacts(received_ns, frame);
    };
    handlers.on_trouble = [this](const std::string& line) {
      troubles_.Say({line, "", true}, clock::MonotonicNs());
    };
    return handlers;
  }

  Result<void> OpenSource(const std::string& text) {
    const auto address = ParseSource(text);
    if (!address) return address.error();
    const bool by_session = *address && ComesBySession(**address);
    if (by_session && session_devices_ != nullptr) return {};  // One for all sessions.
    const auto handlers = HandlersOf(sources_.size());
    const auto new_handle = [this] { return ++last_handle_; };
    if (!*address) {
      sources_.push_back(std::make_unique<devices::HidSource>(io_, new_handle, handlers));
      // Without rights to any device simulated ones still work.
      if (const auto started = sources_.back()->Start(); !started)
        log::Warning(started.error().message);
      return {};
    }
    if (by_session) {
      auto source = std::make_unique<devices::SessionSource>(
          new_handle, handlers,
          devices::SessionLink{[this](std::uint64_t session, const v1::DeviceEnvelope& message) {
                                 server_.SendDevice(session, message);
                               },
                               [this](std::uint64_t session, const std::string& why) {
                                 server_.EndSession(session, why);
                               }});
      session_devices_ = source.get();
      sources_.push_back(std::move(source));
      log::Info("simulated devices of clients with the role control");
      return {};
    }
    sources_.push_back(std::make_unique<devices::SocketSource>(io_, **address, new_handle, handlers,
                                                               config_.device_connections));
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

  void Refuse(DeviceHandle device, const std::string& why) {
    const auto source = source_of_.find(device);
    if (source == source_of_.end()) return;
    sources_[source->second]->Refuse(device, why);
    source_of_.erase(device);
  }

  void WaitForTick() {
    const auto period = std::chrono::nanoseconds(PeriodNanoseconds(config_.tick_rate_hz));
    const auto now = timer::Now();
    next_tick_ += period;
    if (now - next_tick_ > kMostTicksBehind * period) {
      server_.NoteLateTicks(static_cast<std::uint64_t>((now - next_tick_) / period));
      next_tick_ = now;
    }
    timer_.At(next_tick_, [this] {
      Tick();
      WaitForTick();
    });
  }

  void Tick() {
    const std::int64_t now_ns = clock::MonotonicNs();
    const TickContent content = hub_.Tick(now_ns);
    for (const std::string& change : lease_.TakeChanges(now_ns)) log::Info(change);
    if (content.has_status) monitor_.SetDevices(content.status);
    auto channels = ToChannels(content);
    const std::chrono::nanoseconds late = timer::Now() - next_tick_;
    monitor_.OnTick({now_ns, now_ns - late.count(), std::nullopt}, channels);
    server_.Publish(now_ns, channels);
  }

  /// A command with something to keep is answered when it is on the disk; ticks do not wait for
  /// that.
  std::optional<v1::CommandResult> OnCommand(const transport::SessionInfo& session,
                                             const v1::Command& command) {
    const std::uint64_t before = disk_.last_save();
    v1::CommandResult result =
        CarryOut(hub_, lease_, config_, session.session, command, clock::MonotonicNs());
    if (disk_.last_save() == before) return result;
    disk_.OnWritten([this, session = session.session, result](const std::string& problem) mutable {
      const std::string before_it = result.message().empty() ? "" : result.message() + "; ";
      if (!problem.empty())
        result.set_message(before_it + "it lasts until footingd ends: " + problem);
      server_.Answer(session, result);
    });
    return std::nullopt;
  }

  boost::asio::io_context& io_;
  Config config_;
  timer::Timer timer_;
  std::shared_ptr<timer::Timer> lan_warning_;  ///< With insecure_lan.
  timer::TimePoint next_tick_;
  std::vector<std::unique_ptr<devices::DeviceSource>> sources_;
  devices::SessionSource* session_devices_ = nullptr;  ///< One of them; null: none.
  std::map<DeviceHandle, std::size_t> source_of_;
  DeviceHandle last_handle_ = 0;
  LimitedLog changes_{Log};
  LimitedLog troubles_{Log};
  setup::StateDirectory state_;
  setup::DiskWriter disk_;  ///< Writes with state_, so it ends first.
  setup::CalibrationStore calibrations_;
  Hub hub_;
  lease::LeaseControl lease_{"footingd"};
  transport::Server server_;
  monitoring::Monitor monitor_;
  std::optional<discovery::Advertiser> advertiser_;
  std::vector<std::string> listening_on_;
};

Service::Service(std::shared_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Service::~Service() = default;
Result<std::unique_ptr<Service>> Service::Start(boost::asio::io_context& io, const Config& config,
                                                const std::string& version) {
  transport::ServerOptions with_access;
  if (const auto applied = AccessOf(config).Apply(with_access); !applied) return applied.error();
  auto implementation = std::make_shared<Implementation>(io, config, version, with_access);
  if (const auto opened = implementation->Open(); !opened) return opened.error();
  implementation->Start();
  return std::unique_ptr<Service>(new Service(std::move(implementation)));
}

void Service::Stop(const std::string& reason, std::function<void()> done) {
  implementation_->Stop(reason, std::move(done));
}
Result<void> Service::Reload(const Config& wanted) { return implementation_->Reload(wanted); }
std::string Service::Stuck() const { return implementation_->Stuck(); }
std::vector<std::string> Service::listening_on() const { return implementation_->listening_on(); }

void Log(const LogLine& line) {
  const log::Level level = line.warning ? log::Level::kWarning : log::Level::kInfo;
  log::Write(level, line.text, {line.device, 0, ""});
}

void LogOverload(const transport::OverloadLine& line) {
  log::Write(log::Level::kWarning, line.text, {"", line.session, line.channel});
}

}  // namespace footing::sensor
