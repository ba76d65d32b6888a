#include "daemon/simulation/service/service.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/clock/clock.h"
#include "common/config/data_file.h"
#include "common/log/log.h"
#include "common/transport/client.h"
#include "common/transport/server.h"
#include "common/wire/wire.h"
#include "daemon/simulation/service/publish.h"
#include "daemon/simulation/service/sensor_input.h"
#include "daemon/simulation/service/simulation_thread.h"
#include "daemon/simulation/terrain/append.h"

namespace footing::simulation {
namespace {

using Message = google::protobuf::MessageLite;

constexpr std::uint32_t kSkeletons = v1::Tick::kSkeletonsFieldNumber;
constexpr std::uint32_t kTrack = v1::Tick::kTrackFieldNumber;
constexpr std::uint32_t kCharacters = v1::Tick::kCharactersFieldNumber;
constexpr std::uint32_t kEvents = v1::Tick::kEventsFieldNumber;
constexpr std::uint32_t kInputs = v1::Tick::kInputsFieldNumber;

transport::ServerOptions MakeServerOptions(const Config& config, const std::string& version) {
  transport::ServerOptions options;
  options.server_id = "footing-sim";
  options.version = version;
  options.channels = {{"skeletons", kSkeletons, true},
                      {"track", kTrack, true},
                      {"characters", kCharacters, false},
                      {"events", kEvents, false},
                      {"inputs", kInputs, false}};
  options.tick_rate_hz = config.frame_rate_hz;
  options.capabilities = {"gait", "wrist"};
  return options;
}

Result<engine::EngineTexts> ReadTexts(const Config& config) {
  engine::EngineTexts texts;
  const auto biped = config::ReadDataFile(engine::kBipedFile, config.data_folder);
  if (!biped) return biped.error();
  const auto mapping = config::ReadDataFile(engine::kWristMappingFile, config.data_folder);
  if (!mapping) return mapping.error();
  const auto track = config::ReadNamedOrPath(config.track, "tracks", config.data_folder);
  if (!track) return track.error();
  for (const char* name : engine::kGainFiles) {
    const auto gains = config::ReadDataFile(name, config.data_folder);
    if (!gains) return gains.error();
    texts.gains.push_back({name, *gains});
  }
  texts.biped = *biped;
  texts.wrist_mapping = *mapping;
  texts.track = *track;
  return texts;
}

}  // namespace

class Service::Implementation : public std::enable_shared_from_this<Service::Implementation> {
 public:
  Implementation(boost::asio::io_context& io, const Config& config, const std::string& version,
                 engine::GaitEngine engine, const engine::EngineConfig& engine_config,
                 int wake_descriptor)
      : world_(config.track),
        wake_(io, wake_descriptor),
        thread_(std::move(engine), engine_config.step_s,
                static_cast<int>(std::lround(1.0 / (engine_config.step_s * config.frame_rate_hz))),
                wake_descriptor),
        track_(thread_.engine().track()),
        input_(config.rig, thread_.inputs(), responses_),
        server_(io, MakeServerOptions(config, version),
                {[this](const transport::SessionInfo&, const v1::Command& command) {
                   return input_.OnCommand(command);
                 },
                 {}}) {}

  Result<void> Open(boost::asio::io_context& io, const Config& config) {
    auto addresses = config.listen;
    if (addresses.empty()) {
      addresses.push_back(transport::DefaultAddress("simulation", true).Text());
    }
    for (const std::string& text : addresses) {
      const auto address = transport::ParseAddress(text);
      if (!address) return address.error();
      if (const auto listening = server_.Listen(*address); !listening) return listening;
      log::Info("listening on " + address->Text());
    }
    transport::ClientOptions options;
    options.address = transport::DefaultAddress("sensor");
    if (!config.sensor.empty()) {
      const auto address = transport::ParseAddress(config.sensor);
      if (!address) return address.error();
      options.address = *address;
    }
    options.client_name = "footing-sim";
    options.channels = {"features"};
    options.policy = v1::QUEUE_POLICY_LATEST;
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { input_.OnTick(tick, clock::MonotonicNs()); };
    handlers.on_state = [](transport::LinkState, const std::string& why) {
      log::Info("sensor stream: " + why);
    };
    client_ = std::make_unique<transport::Client>(io, options, std::move(handlers));
    return {};
  }

  void Start() {
    PublishRetained();
    client_->Start();
    thread_.Start();
    WaitForFrame();
  }

  void Stop(const std::string& reason) {
    client_->Stop();
    thread_.Stop();
    boost::system::error_code ignored;
    wake_.close(ignored);
    server_.Stop(reason);
  }

 private:
  static transport::ChannelBytes Bytes(std::uint32_t field, const Message& message) {
    return {field, message.SerializeAsString()};
  }

  void PublishRetained() {
    v1::Skeletons skeletons;
    skeletons.set_world(world_);
    *skeletons.add_skeletons() = wire::ToProto(thread_.engine().skeleton());
    const v1::Track track = wire::ToProto(track_);
    server_.Publish(clock::MonotonicNs(), {Bytes(kSkeletons, skeletons), Bytes(kTrack, track)});
  }

  void WaitForFrame() {
    wake_.async_read_some(
        boost::asio::buffer(&wakes_, sizeof(wakes_)),
        [self = shared_from_this()](boost::system::error_code error, std::size_t) {
          if (error) return;
          self->PublishFrames();
          self->WaitForFrame();
        });
  }

  void PublishFrames() {
    while (thread_.frames().Pop(frame_)) PublishFrame(frame_);
  }

  void PublishFrame(const Frame& frame) {
    const std::int64_t now_ns = clock::MonotonicNs();
    input_.OnFrame(frame);
    std::vector<transport::ChannelBytes> channels;
    for (int i = 0; i < frame.added_count; ++i) {
      terrain::Add(frame.added[static_cast<std::size_t>(i)], track_);
    }
    if (frame.added_count > 0) channels.push_back(Bytes(kTrack, wire::ToProto(track_)));
    channels.push_back(Bytes(kCharacters, ToCharacterFrame(frame, world_, input_.rig())));
    v1::Events events;
    for (int i = 0; i < frame.event_count; ++i) {
      *events.add_events() = ToEvent(frame.events[static_cast<std::size_t>(i)], now_ns);
    }
    v1::ResponseStages stages;
    if (responses_.Complete(frame, now_ns, stages)) {
      v1::Event& event = *events.add_events();
      event.set_kind(v1::Event::KIND_RESPONSE);
      event.set_host_ns(now_ns);
      event.set_character(1);
      event.set_gait(stages.to());
      *event.mutable_response() = stages;
    }
    if (events.events_size() > 0) channels.push_back(Bytes(kEvents, events));
    v1::AppliedInputs inputs;
    for (int i = 0; i < frame.applied_count; ++i) {
      *inputs.add_inputs() = ToAppliedInput(frame.applied[static_cast<std::size_t>(i)]);
    }
    if (inputs.inputs_size() > 0) channels.push_back(Bytes(kInputs, inputs));
    server_.Publish(now_ns, std::move(channels));
  }

  const std::string world_;
  boost::asio::posix::stream_descriptor wake_;
  std::uint64_t wakes_ = 0;
  Frame frame_;
  Responses responses_;
  SimulationThread thread_;
  stream::Track track_;  ///< The engine's, as of the last frame: the engine is its thread's alone.
  SensorInput input_;
  transport::Server server_;
  std::unique_ptr<transport::Client> client_;
};

Service::Service(std::shared_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

Service::~Service() = default;

Result<std::unique_ptr<Service>> Service::Start(boost::asio::io_context& io, const Config& config,
                                                const std::string& version) {
  if (const auto built = CheckBuilt(config); !built) return built.error();
  const auto texts = ReadTexts(config);
  if (!texts) return texts.error();
  engine::EngineConfig engine_config;
  engine_config.fall_shown_s = config.fall_shown_s;
  engine_config.put_back_distance_m = config.put_back_distance_m;
  engine_config.features_timeout_s = config.features_timeout_s;
  auto engine = engine::GaitEngine::Create(*texts, engine_config);
  if (!engine) return engine.error();
  const int wake_descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (wake_descriptor < 0) return Failure(std::string("eventfd: ") + std::strerror(errno));
  auto implementation = std::make_shared<Implementation>(
      io, config, version, std::move(engine).value(), engine_config, wake_descriptor);
  if (const auto open = implementation->Open(io, config); !open) return open.error();
  implementation->Start();
  return std::unique_ptr<Service>(new Service(std::move(implementation)));
}

void Service::Stop(const std::string& reason) { implementation_->Stop(reason); }

}  // namespace footing::simulation
