#include "clients/log/lsl_out.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include <boost/asio/io_context.hpp>

#include "clients/log/commands.h"
#include "clients/log/record.h"
#include "common/base/text.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/net/tick.h"
#include "common/recording/event_text.h"
#include "common/recording/stream_recorder.h"
#include "common/runtime/service_manager.h"
#include "common/stream/device.h"
#include "common/wire/wire.h"

namespace footing::log_client {
namespace {

using lsl::Channel;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// A board that is silent for longer does not count for the COP of both.
constexpr double kOldestLoadS = 0.5;

double If(bool valid, double value) { return valid ? value : kNone; }

const std::vector<Channel> kMotion = {{"specific_force_mps2_x", "m/s^2"},
                                      {"specific_force_mps2_y", "m/s^2"},
                                      {"specific_force_mps2_z", "m/s^2"},
                                      {"filtered_mps2_x", "m/s^2"},
                                      {"filtered_mps2_y", "m/s^2"},
                                      {"filtered_mps2_z", "m/s^2"},
                                      {"angular_velocity_radps_x", "rad/s"},
                                      {"angular_velocity_radps_y", "rad/s"},
                                      {"angular_velocity_radps_z", "rad/s"},
                                      {"clipped_axes", ""},
                                      {"buttons", ""}};
const std::vector<Channel> kBoards = {
    {"top_left_n", "N"}, {"top_right_n", "N"}, {"bottom_left_n", "N"}, {"bottom_right_n", "N"},
    {"total_n", "N"},    {"cop_x_m", "m"},     {"cop_y_m", "m"}};
const std::vector<Channel> kCop = {{"load_n", "N"}, {"cop_x_m", "m"}, {"cop_y_m", "m"}};
const std::vector<Channel> kFeatures = {
    {"moving", ""},       {"frequency_hz", "Hz"}, {"amplitude_mps2", "m/s^2"}, {"roll_rad", "rad"},
    {"pitch_rad", "rad"}, {"swing_rad", "rad"},   {"axial_rad", "rad"}};
const std::vector<Channel> kPhase = {{"phase_rad", "rad"}, {"phase_held", ""}};
const std::vector<Channel> kCom = {{"com_m_x", "m"},
                                   {"com_m_y", "m"},
                                   {"com_m_z", "m"},
                                   {"com_velocity_mps_x", "m/s"},
                                   {"com_velocity_mps_y", "m/s"},
                                   {"com_velocity_mps_z", "m/s"}};
const std::vector<Channel> kGait = {{"gait", ""},
                                    {"commanded_gait", ""},
                                    {"commanded_speed_mps", "m/s"},
                                    {"commanded_height_m", "m"},
                                    {"commanded_turn_rad", "rad"},
                                    {"speed_mps", "m/s"},
                                    {"heading_rad", "rad"},
                                    {"steps", ""},
                                    {"falls", ""},
                                    {"distance_m", "m"}};

constexpr char kSensorFrame[] = "sensor frame S: x left, y front, z down";
constexpr char kPlateFrame[] = "plate frame P: x right, y front, origin in the plate's middle";
constexpr char kWorldFrame[] = "world frame W: x forward, y left, z up";

std::string RoleOf(int number) {
  return number == 0 ? "" : stream::Name(static_cast<stream::DeviceRole>(number));
}

}  // namespace

void LslStreams::Begin(const std::string& server, double tick_hz) {
  server_ = server;
  tick_hz_ = tick_hz;
  devices_.clear();  // Their numbers are those of one run of the server.
  streams_.clear();
  if (Wants("events")) Stream({"events", 0}, "events", "events", "Markers", 0, {{"event", ""}}, {});
}

void LslStreams::Take(const v1::Tick& tick, std::int64_t offset_ns) {
  offset_ns_ = offset_ns;
  const double time_s = SecondsOf(tick.host_ns());
  if (tick.has_status()) TakeStatus(tick.status());
  if (tick.has_setup()) TakeSetup(tick.setup(), time_s);
  for (const v1::Skeleton& skeleton : tick.skeletons().skeletons()) {
    skeletons_[skeleton.character()] = skeleton;
  }
  if (Wants("motion")) TakeMotion(tick.motion());
  TakeBoards(tick.boards());
  if (Wants("features")) TakeFeatures(tick.features(), time_s);
  for (const v1::Character& character : tick.characters().characters()) {
    TakeCharacter(character, time_s);
  }
  if (Wants("events")) TakeEvents(tick.events(), time_s);
}

void LslStreams::TakeStatus(const v1::DeviceStatusList& status) {
  for (const v1::DeviceStatus& one : status.devices()) {
    const Device device{one.serial(), one.name(), one.rig(), RoleOf(one.role()), one.simulated()};
    Device& known = devices_[one.device()];
    if (known == device) continue;
    known = device;
    // Its streams have the role in their names.
    std::erase_if(streams_, [&one](const auto& entry) {
      const std::uint64_t number = std::get<1>(entry.first);
      return number == one.device() || number >> 32 == one.device();
    });
  }
}

void LslStreams::TakeMotion(const v1::MotionSamples& motion) {
  for (const v1::MotionSample& sample : motion.samples()) {
    const auto stream = DeviceStream("motion", "motion", "Accelerometer", sample.device(), 0,
                                     kMotion, kSensorFrame);
    const v1::Vector3 &raw = sample.specific_force_mps2(), &filtered = sample.filtered_mps2(),
                      &rate = sample.angular_velocity_radps();
    const bool has_rate = sample.has_angular_velocity_radps();
    Push(stream, SecondsOf(sample.sampled_ns()),
         {raw.x(), raw.y(), raw.z(), filtered.x(), filtered.y(), filtered.z(),
          If(has_rate, rate.x()), If(has_rate, rate.y()), If(has_rate, rate.z()),
          double(sample.clipped_axes()), double(sample.buttons())});
  }
}

void LslStreams::TakeBoards(const v1::BoardSamples& boards) {
  std::map<std::string, double> newest_s;
  for (const v1::BoardSample& sample : boards.samples()) {
    const double time_s = SecondsOf(sample.sampled_ns());
    if (Wants("boards")) {
      Push(DeviceStream("boards", "boards", "Force", sample.device(), 0, kBoards, kPlateFrame),
           time_s,
           {sample.top_left_n(), sample.top_right_n(), sample.bottom_left_n(),
            sample.bottom_right_n(), sample.total_n(), If(sample.cop_valid(), sample.cop_x_m()),
            If(sample.cop_valid(), sample.cop_y_m())});
    }
    const auto device = devices_.find(sample.device());
    if (!Wants("cop") || device == devices_.end()) continue;
    const auto& [rig, role] = std::tie(device->second.rig, device->second.role);
    const auto layout = layouts_.find(rig);
    const stream::BoardLayout places = layout == layouts_.end()
                                           ? board::DefaultLayout()
                                           : board::LayoutOr(wire::FromProto(layout->second));
    const auto& pose = role == "right_board" ? places.right : places.left;
    const Eigen::Vector2d p_W = board::InWorld(pose, sample.cop_x_m(), sample.cop_y_m());
    loads_[rig][role] = {time_s, sample.total_n(), sample.cop_valid(), p_W.x(), p_W.y()};
    newest_s[rig] = std::max(time_s, newest_s.try_emplace(rig, time_s).first->second);
  }
  for (const auto& [rig, time_s] : newest_s) {
    double load_n = 0, on_n = 0, x = 0, y = 0;
    for (const auto& [role, load] : loads_[rig]) {
      if (load.time_s < time_s - kOldestLoadS) continue;
      load_n += load.total_n;
      if (!load.valid) continue;
      on_n += load.total_n;
      x += load.total_n * load.x_m;
      y += load.total_n * load.y_m;
    }
    const std::string name = "cop" + (rig.empty() ? "" : "/" + rig);
    Push(Stream({name, 0}, name, name, "Force", 0, kCop, {{"frame", kWorldFrame}, {"rig", rig}}),
         time_s, {load_n, If(on_n > 0, x / on_n), If(on_n > 0, y / on_n)});
  }
}

void LslStreams::TakeFeatures(const v1::FeatureFrame& features, double time_s) {
  for (const v1::RigFeatures& rig : features.rigs()) {
    const std::string topic = "features" + (rig.rig().empty() ? "" : "/" + rig.rig());
    for (const v1::DeviceFeatures& one : rig.devices()) {
      const auto stream = DeviceStream("features", topic, "features", one.device(), tick_hz_,
                                       kFeatures, kSensorFrame);
      Push(stream, time_s,
           {double(one.moving()), If(one.frequency_valid(), one.frequency_hz()),
            If(one.amplitude_valid(), one.amplitude_mps2()),
            If(one.inclination_valid(), one.roll_rad()),
            If(one.inclination_valid(), one.pitch_rad()), If(one.swing_valid(), one.swing_rad()),
            If(one.axial_valid(), one.axial_rad())});
    }
    for (const v1::PairFeatures& pair : rig.pairs()) {
      const auto left = devices_.find(pair.left_device()),
                 right = devices_.find(pair.right_device());
      if (left == devices_.end() || right == devices_.end()) continue;
      const std::uint64_t number = std::uint64_t{pair.left_device()} << 32 | pair.right_device();
      Push(Stream({"phase", number}, topic + "/" + left->second.role + "-" + right->second.role,
                  topic + "/" + left->second.serial + "-" + right->second.serial, "features",
                  tick_hz_, kPhase, {{"rig", rig.rig()}}),
           time_s, {If(pair.phase_valid(), pair.phase_rad()), double(pair.phase_held())});
    }
  }
}

void LslStreams::TakeCharacter(const v1::Character& character, double time_s) {
  const std::uint32_t number = character.character();
  const std::string name = "characters/" + std::to_string(number);
  const bool valid = character.valid();
  if (Wants("com")) {
    const v1::Vector3 &com = character.com_m(), &v = character.com_velocity_mps();
    Push(Stream({"com", number}, name + "/com", name + "/com", "MoCap", tick_hz_, kCom,
                {{"frame", kWorldFrame}, {"rig", character.rig()}}),
         time_s,
         {If(valid, com.x()), If(valid, com.y()), If(valid, com.z()), If(valid, v.x()),
          If(valid, v.y()), If(valid, v.z())});
  }
  if (character.has_gait() && Wants("gait")) {
    const v1::GaitState& gait = character.gait();
    Push(Stream({"gait", number}, name + "/gait", name + "/gait", "Gait", tick_hz_, kGait,
                {{"frame", kWorldFrame}, {"gaits", "1 step, 2 walk, 3 run, 4 jump"}}),
         time_s,
         {double(gait.gait()), double(gait.commanded_gait()), gait.commanded_speed_mps(),
          gait.commanded_height_m(), gait.commanded_turn_rad(), gait.speed_mps(),
          gait.heading_rad(), double(gait.steps()), double(gait.falls()), gait.distance_m()});
    std::string& phase = phases_[number];
    if (phase != gait.phase()) {
      phase = gait.phase();
      PushText("phase", number, time_s, phase);
    }
  }
  const auto skeleton = skeletons_.find(number);
  if (skeleton != skeletons_.end()) TakePose(character, skeleton->second, time_s);
}

void LslStreams::TakePose(const v1::Character& character, const v1::Skeleton& skeleton,
                          double time_s) {
  const std::uint32_t number = character.character();
  const std::string name = "characters/" + std::to_string(number);
  const auto known = [&](const char* kind) { return streams_.contains({kind, number}); };
  std::vector<Channel> channels;
  std::vector<double> values;
  if (Wants("pose") && character.links_size() > 0 &&
      character.links_size() == skeleton.links_size()) {
    for (int i = 0; i < character.links_size() && !known("pose"); ++i) {
      for (const char* part : {"_position_m_x", "_position_m_y", "_position_m_z"})
        channels.push_back({skeleton.links(i).name() + part, "m"});
      for (const char* part :
           {"_orientation_w", "_orientation_x", "_orientation_y", "_orientation_z"})
        channels.push_back({skeleton.links(i).name() + part, ""});
    }
    for (const v1::LinkPose& link : character.links()) {
      const v1::Vector3& p = link.position_m();
      const v1::Quaternion& q = link.orientation();
      for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()})
        values.push_back(If(character.valid(), value));
    }
    Push(Stream({"pose", number}, name + "/pose", name + "/pose", "MoCap", tick_hz_, channels,
                {{"frame", kWorldFrame}, {"skeleton", skeleton.name()}, {"rig", character.rig()}}),
         time_s, values);
  }
  if (!Wants("contacts") || character.contacts_size() == 0 ||
      character.contacts_size() != skeleton.contact_points_size())
    return;
  channels.clear();
  values.clear();
  for (const std::string& point : skeleton.contact_points()) {
    channels.push_back({point + "_touching", ""});
    channels.push_back({point + "_normal_force_n", "N"});
  }
  for (const v1::Contact& contact : character.contacts()) {
    values.push_back(double(contact.touching()));
    values.push_back(contact.normal_force_n());
  }
  Push(Stream({"contacts", number}, name + "/contacts", name + "/contacts", "Force", tick_hz_,
              channels, {}),
       time_s, values);
}

void LslStreams::TakeEvents(const v1::Events& events, double time_s) {
  for (const v1::Event& event : events.events()) {
    PushText("events", 0, event.host_ns() != 0 ? SecondsOf(event.host_ns()) : time_s,
             recording::EventText(event));
  }
}

void LslStreams::TakeSetup(const v1::SetupState& setup, double time_s) {
  for (const v1::RigSetup& rig : setup.rigs()) {
    if (rig.has_layout()) layouts_[rig.rig()] = rig.layout();
    if (!rig.has_prompt() || prompts_[rig.rig()] == rig.prompt().number()) continue;
    prompts_[rig.rig()] = rig.prompt().number();
    if (Wants("events")) PushText("events", 0, time_s, "PROMPT: " + rig.prompt().text());
  }
}

std::optional<std::size_t> LslStreams::DeviceStream(const char* kind, const std::string& topic,
                                                    const char* type, std::uint32_t device,
                                                    double rate_hz,
                                                    const std::vector<Channel>& channels,
                                                    const char* frame) {
  if (const auto there = streams_.find({kind, device}); there != streams_.end())
    return there->second;
  const auto found = devices_.find(device);
  if (found == devices_.end()) return std::nullopt;  // Its status comes within a second.
  const Device& one = found->second;
  const std::string about = one.role.empty() ? std::to_string(device) : one.role;
  return Stream({kind, device}, topic + "/" + about, topic + "/" + about + "/" + one.serial, type,
                rate_hz, channels,
                {{"frame", frame},
                 {"rig", one.rig},
                 {"role", one.role},
                 {"simulated", one.simulated ? "true" : "false"},
                 {"model", one.name},
                 {"serial_number", one.serial}});
}

std::optional<std::size_t> LslStreams::Stream(const Key& key, const std::string& name,
                                              const std::string& source, const char* type,
                                              double rate_hz, const std::vector<Channel>& channels,
                                              const Notes& notes) {
  const auto there = streams_.find(key);
  if (there != streams_.end()) return there->second;
  lsl::Info info;
  info.name = server_ + "/" + name;
  info.source_id = server_ + "/" + source;
  info.type = type;
  info.format = type == std::string_view("Markers") ? lsl::Format::kString : lsl::Format::kDouble64;
  info.channels = channels.size();
  info.nominal_hz = rate_hz;
  info.description = lsl::Describe(channels, type, notes);
  const std::string own = info.source_id + " " + std::to_string(info.channels);
  if (const auto old = by_source_.find(own); old != by_source_.end())
    return streams_[key] = old->second;
  // Two rigs have devices of one role.
  if (!names_.insert(info.name).second) info.name += "_" + std::to_string(std::get<1>(key));
  const auto added = outlets_.Add(std::move(info));
  if (!added) {
    if (problem_.empty()) std::cerr << "error: " << added.error().message << std::endl;
    problem_ = added.error().message;
    return streams_[key] = std::nullopt;
  }
  const lsl::Info& offered = outlets_.info(*added);
  std::cerr << "offering " << offered.name << ", " << offered.type << ", " << offered.channels
            << (offered.channels == 1 ? " channel" : " channels") << ", port " << offered.data_port
            << std::endl;
  by_source_[own] = *added;
  return streams_[key] = *added;
}

void LslStreams::Push(std::optional<std::size_t> stream, double time_s,
                      const std::vector<double>& values) {
  // A skeleton may get other links; what has another length then waits for the next run.
  if (stream && outlets_.info(*stream).channels == values.size())
    outlets_.Push(*stream, time_s, values);
}

void LslStreams::PushText(const char* name, std::uint64_t number, double time_s,
                          const std::string& text) {
  const std::string whole =
      number == 0 ? name : "characters/" + std::to_string(number) + "/" + name;
  const auto stream = Stream({name, number}, whole, whole, "Markers", 0, {{name, ""}}, {});
  if (stream) outlets_.Push(*stream, time_s, text);
}

namespace {

class LslOffer {
 public:
  LslOffer(boost::asio::io_context& io, const LslOptions& options,
           std::unique_ptr<lsl::Outlets> outlets)
      : io_(io), options_(options), outlets_(std::move(outlets)), end_(io, [this] { End(); }) {}

  Result<std::vector<lsl::OutletReport>> Run() {
    for (const transport::Address& address : options_.addresses) AddServer(address);
    for (const auto& server : servers_) server->client->Start();
    end_.After(options_.seconds, [this] { End(); });
    io_.run();
    std::vector<lsl::OutletReport> reports;
    for (std::size_t i = 0; i < outlets_->size(); ++i) reports.push_back(outlets_->report(i));
    if (!reports.empty()) return reports;
    std::string waited_for;
    for (const auto& server : servers_) {
      waited_for +=
          (waited_for.empty() ? "" : ", ") + server->address.Text() + " (" + server->why + ")";
    }
    return NoDevice("nothing to offer from " + waited_for +
                    "; start a server, or name it with --connect");
  }

 private:
  struct Server {
    transport::Address address;
    LslStreams streams;
    std::string why = "not connected yet";
    std::unique_ptr<transport::Client> client{};
  };

  void AddServer(const transport::Address& address) {
    servers_.push_back(
        std::make_unique<Server>(Server{address, LslStreams(*outlets_, options_.kinds)}));
    Server* const server = servers_.back().get();
    transport::ClientOptions client;
    client.address = address;
    client.client_name = "footing-log lsl";
    client.channels = {"status",   "setup",     "motion",     "boards",
                       "features", "skeletons", "characters", "events"};
    client.queue_ticks = 1024;
    transport::ClientHandlers handlers;
    handlers.on_welcome = [this, server](const v1::Welcome& welcome) {
      server->streams.Begin(names_.Of(welcome.server_id(), server->address.Text()),
                            transport::TickRateOf(welcome, 0));
    };
    handlers.on_tick = [server](const v1::Tick& tick) {
      const std::int64_t host_ns = tick.host_ns();
      const std::int64_t there_ns =
          transport::OnServersClock(server->address, server->client->clock(), host_ns);
      if (there_ns == 0) return;  // The clock's offset is known after the first answer to a ping.
      server->streams.Take(tick, there_ns - host_ns);
    };
    handlers.on_gap = [server](const v1::Gap& gap) {
      std::cerr << server->address.Text() << ": ticks " << gap.from_sequence() << " to "
                << gap.to_sequence() << " are missing" << std::endl;
    };
    handlers.on_state = [server](transport::LinkState, const std::string& why) {
      server->why = why;
      if (!why.empty()) std::cerr << server->address.Text() << ": " << why << std::endl;
    };
    server->client = std::make_unique<transport::Client>(io_, client, std::move(handlers));
  }

  void End() {
    for (const auto& server : servers_) server->client->Stop();
    io_.stop();
  }

  boost::asio::io_context& io_;
  const LslOptions& options_;
  std::unique_ptr<lsl::Outlets> outlets_;
  recording::ServerNames names_;
  std::vector<std::unique_ptr<Server>> servers_;
  service_manager::ProgramEnd end_;
};

}  // namespace

Result<std::vector<lsl::OutletReport>> OfferLsl(const LslOptions& options) {
  boost::asio::io_context io(1);
  auto outlets = lsl::Outlets::Open(io, options.outlets);
  if (!outlets) return outlets.error();
  return LslOffer(io, options, std::move(*outlets)).Run();
}

namespace {

Result<nlohmann::ordered_json> RunLsl(LslOptions options, const std::vector<std::string>& connect,
                                      const std::string& kinds) {
  auto addresses = RecordedAddresses(connect);
  if (!addresses) return addresses.error();
  options.addresses = std::move(*addresses);
  for (const std::string_view kind : text::Fields(kinds, ',')) {
    if (std::find(std::begin(kLslKinds), std::end(kLslKinds), kind) == std::end(kLslKinds)) {
      return UsageError("--streams " + kinds + ": there is no " + text::Quoted(kind) +
                        "; there are: " + text::Joined(kLslKinds));
    }
    options.kinds.emplace(kind);
  }
  const auto reports = OfferLsl(options);
  if (!reports) return reports.error();
  nlohmann::ordered_json out{{"streams", nlohmann::ordered_json::array()}};
  for (const lsl::OutletReport& one : *reports) {
    out["streams"].push_back({{"name", one.name},
                              {"type", one.type},
                              {"channels", one.channels},
                              {"samples", one.samples},
                              {"readers", one.feeds},
                              {"dropped_readers", one.dropped}});
  }
  return out;
}

}  // namespace

void AddLslCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "lsl", "Offer what the servers send to programs of the Lab Streaming Layer, live");
  const auto options = std::make_shared<LslOptions>();
  const auto connect = std::make_shared<std::vector<std::string>>();
  const auto kinds = std::make_shared<std::string>(text::Joined(kLslKinds, ","));
  command->add_option(
      "--connect", *connect,
      "Address of a server, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated (default: "
      "this user's sensor and simulation servers)");
  command->add_option("--streams", *kinds, "Kinds of streams to offer, with commas between them")
      ->capture_default_str();
  command
      ->add_option("--interface", options->outlets.interface,
                   "IPv4 address of this host that streams are offered on")
      ->capture_default_str();
  command->add_flag("--insecure-lan", options->outlets.insecure_lan,
                    "Allow an --interface beyond this host: ANYBODY there may read the streams");
  command->add_option("--seconds", options->seconds, "Duration, s (default: until SIGINT)")
      ->check(CLI::Range(0.1, 1e6));
  command->footer(
      "Examples:\n"
      "  footing-log lsl                              # all streams, to programs of this host\n"
      "  footing-log lsl --streams boards,cop,events  # a board and markers alone");
  command->callback([=, &shared] { Finish(RunLsl(*options, *connect, *kinds), shared); });
}

}  // namespace footing::log_client
