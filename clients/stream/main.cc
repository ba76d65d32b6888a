#include <boost/asio/io_context.hpp>

#include "clients/stream/boards.h"
#include "clients/stream/body_stage.h"
#include "clients/stream/dialer.h"
#include "clients/stream/network_sensors.h"
#include "clients/stream/plan.h"
#include "clients/stream/samples.h"
#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/net/device_link.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace {

using namespace footing;  // NOLINT: main is wiring

/// Work of the io_context beside the devices; `end` ends the program.
using End = std::function<void(const std::string& why)>;
using Beside =
    std::function<std::unique_ptr<transport::Client>(boost::asio::io_context&, const End& end)>;

int Run(Result<stream_client::Plan> plan, const stream_client::Common& common,
        const Beside& beside = nullptr) {
  if (!plan) return cli::Report(plan.error());
  if (plan->devices.empty() && plan->feeds.empty())
    return cli::Report(UsageError("name --left FILE, --right FILE or both"));
  const auto to = transport::AddressOrDefault(common.to, "devices");
  if (!to) return cli::Report(to.error());
  if (const auto done = clock::FollowTimekeeper(); !done) return cli::Report(done.error());
  boost::asio::io_context io(1);
  bool came_in_time = true;
  std::unique_ptr<stream_client::Dialer> dialer;
  std::unique_ptr<transport::Client> eyes;
  std::optional<service_manager::ProgramEnd> program_end;
  const End end = [&](const std::string& why) {
    log::Info(why);
    dialer->Stop(why);
    if (eyes) eyes->Stop();
    program_end->cancel();
  };
  if (beside) eyes = beside(io, end);
  dialer = std::make_unique<stream_client::Dialer>(
      io, stream_client::DialerOptions{*to, common.rate_scale}, std::move(plan).value(),
      [&] { end("the motion has ended"); });
  program_end.emplace(io, [&] { end("stopped"); });
  program_end->After(common.seconds, [&] {
    came_in_time = dialer->has_attached();
    end("the time is up");
  });
  dialer->Start();
  timer::Run(io);
  if (came_in_time && dialer->all_refused()) {
    return cli::Report(Failure("footingd refused every device; its reasons are above"));
  }
  if (came_in_time) return 0;
  return cli::Report(dialer->NeverAttached());
}

int RunPlayer(const std::string& simulation, const stream_client::Common& common) {
  const auto at = transport::AddressOrDefault(simulation, "simulation");
  if (!at) return cli::Report(at.error());
  auto planned = stream_client::PlanRunner(common);
  if (!planned) return cli::Report(planned.error());
  return Run(std::move(planned->plan), common, [&](boost::asio::io_context& io, const End&) {
    return stream_client::Watch(
        io, *at, {"characters", "track"},
        [runner = planned->runner](const v1::Tick& tick) { runner->See(tick); });
  });
}

int RunRehearse(const stream_client::RehearseOptions& options,
                const stream_client::Common& common) {
  const auto at = transport::AddressOrDefault(options.sensor, "sensor");
  if (!at) return cli::Report(at.error());
  auto planned = stream_client::PlanSetupPerson(options.person, common);
  if (!planned) return cli::Report(planned.error());
  const auto record = std::make_shared<stream_client::SetupRecord>();
  const int code =
      Run(std::move(planned->plan), common, [&](boost::asio::io_context& io, const End& end) {
        const auto person = std::make_shared<stream_client::SetupPerson>(
            io, planned->body, options.person.rig, record, [once = options.person.once, end] {
              if (once) end("the setup has ended");
            });
        return stream_client::Watch(io, *at, {"setup"},
                                    [person](const v1::Tick& tick) { person->See(tick); });
      });
  if (code == 0) stream_client::PrintAsked(*record, options.json);
  return code;
}

void AddCommon(CLI::App& app, stream_client::Common& common) {
  app.add_option("--to", common.to, device_link::kToHelp);
  app.add_option("--seed", common.seed, "Seed of calibrations, noise and link");
  app.add_option("--link", common.link, "Link model: ideal, good or poor");
  app.add_option("--rate-scale", common.rate_scale, "Ratio of the devices' clock rates to nominal")
      ->check(CLI::Range(0.1, 10.0));
  app.add_option("--seconds", common.seconds,
                 "Duration, s, including the wait for footingd (default: until SIGINT)")
      ->check(CLI::Range(0.0, 1e6));
}

int RunUser(const stream_client::UserOptions& user, const stream_client::Common& common) {
  const auto devices = stream_client::HeldKindNamed(user.devices);
  if (!devices) return cli::Report(devices.error());
  if (user.see.empty() && !user.ranges) {
    stream_client::Held held = user.held;
    held.kind = *devices;
    return Run(stream_client::PlanUser(user.script, user.interface, common, held), common);
  }
  auto live = stream_client::PlanLiveUser({user.interface, user.turn_by, user.grip_deg,
                                           user.grip_way, user.style, user.ranges, *devices},
                                          common, user.style_seed.value_or(common.seed));
  if (!live) return cli::Report(live.error());
  if (user.ranges) return Run(std::move(live->plan), common);
  const auto simulation = transport::ParseAddress(user.see);
  if (!simulation) return cli::Report(simulation.error());
  return Run(std::move(live->plan), common, [&](boost::asio::io_context& io, const End&) {
    return stream_client::Watch(io, *simulation, {"characters", "track"},
                                [user = live->user](const v1::Tick& tick) { user->See(tick); });
  });
}

int RunSensors(const stream_client::SensorsOptions& options, const stream_client::Common& common) {
  const auto to = transport::AddressOrDefault(common.to, "devices");
  if (!to) return cli::Report(to.error());
  const auto done = stream_client::RunSensors(options, *to, common.seconds);
  return done ? 0 : cli::Report(done.error());
}

/// Files that the devices of `accel` and `corners` play.
struct Recorded {
  std::string left, right;
  double rate_hz = 100;
};

std::pair<CLI::App*, CLI::App*> AddRecorded(CLI::App& app, Recorded& files) {
  auto* accel = app.add_subcommand(
      "accel", "Wiimotes that play recorded accelerations, CSV ax,ay,az in m/s2");
  auto* corners = app.add_subcommand(
      "corners", "Boards that play recorded corner loads, CSV time_s,tl_kg,tr_kg,bl_kg,br_kg");
  for (auto* recorded : {accel, corners}) {
    recorded->add_option("--left", files.left, "Recording of the left device, CSV");
    recorded->add_option("--right", files.right, "Recording of the right device, CSV");
  }
  accel->add_option("--rate-hz", files.rate_hz, "Sample rate of the CSV files, Hz")
      ->required()
      ->default_str("");
  return {accel, corners};
}

constexpr char kExamples[] =
    "  footing-stream user --script demo --interface wrist\n"
    "  footing-stream user --devices joycon --interface joystick\n"
    "  footing-stream user --interface leg --see tcp:localhost:7411 --seed 3\n"
    "  footing-stream user --interface leg --ranges --tempo 0.8    # for footing-study ranges\n"
    "  footing-stream sample .     # writes the files that these examples read\n"
    "  footing-stream accel --left left.csv --right right.csv --rate-hz 100\n"
    "  footing-stream corners --left corners.csv --link poor --seconds 60\n"
    "  footing-stream boards --motion demo --hands move\n"
    "  footing-stream boards --motion demo --hands move --head sphere\n"
    "  footing-stream boards --motion demo --hands wiimote --lose-hand left "
    "--lose-from-s 12 --lose-for-s 2\n"
    "  footing-stream boards --motion clip.bvh --place-boards\n"
    "  footing-stream insoles --motion clip.bvh --hands move\n"
    "  footing-stream runner &     # the terrain game's two players, see footing-game\n"
    "  footing-stream builder\n"
    "  footing-stream rehearse     # performs what footing-ctl setup asks for in another terminal\n"
    "  footing-stream sensors --listen 192.168.1.5:6969 --role left_hand --role right_hand\n"
    "  footing-stream replay walk.mcap\n"
    "  FOOTING_TOKEN_FILE=token footing-stream user --to tls:192.168.1.5:7432    # another host\n";

}  // namespace

int main(int argc, char** argv) {
  auto app =
      cli::NewApp("footing-stream",
                  "Simulates devices at the level of raw HID reports, over a socket, and brings in "
                  "real sensors of the network.",
                  kExamples);
  stream_client::Common common;
  bool quiet = false, replace = false;
  AddCommon(*app, common);
  app->add_flag("-q,--quiet", quiet, "Log only warnings and errors");
  app->require_subcommand(1);
  app->fallthrough();

  stream_client::UserOptions person;
  auto* user = stream_client::AddUserCommand(*app, person);
  Recorded files;
  const auto [accel, corners] = AddRecorded(*app, files);
  stream_client::BoardsOptions under;
  auto* boards = stream_client::AddBoardsCommand(*app, under);
  stream_client::InsolesOptions insoles_options;
  auto* insoles = stream_client::AddInsolesCommand(*app, insoles_options);
  std::string sample_folder = ".";
  auto* sample = app->add_subcommand(
      "sample", "Write small sample files for the examples of every program, and end");
  sample->add_option("FOLDER", sample_folder, "Folder to write into (default: this one)");
  sample->add_flag("--force", replace, "Replace files of the same names that have other content");
  stream_client::PlayersOptions players;
  auto* runner = stream_client::AddRunnerCommand(*app, players);
  auto* builder = stream_client::AddBuilderCommand(*app, players);
  stream_client::RehearseOptions setup_options;
  auto* rehearse = stream_client::AddRehearseCommand(*app, setup_options);
  stream_client::SensorsOptions sensors_options;
  auto* sensors = stream_client::AddSensorsCommand(*app, sensors_options);
  std::string recording;
  auto* replay = app->add_subcommand("replay", "The devices of a recording, with its raw reports");
  replay->add_option("FILE", recording, "Recording, MCAP file")->required();
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  log::Start("footing-stream", quiet);

  if (*sample) {
    const auto written = stream_client::WriteSampleFiles(sample_folder, replace);
    return written ? 0 : cli::Report(written.error());
  }
  if (*sensors) return RunSensors(sensors_options, common);
  if (*replay) return Run(stream_client::PlanReplay(recording, common), common);
  if (*rehearse) return RunRehearse(setup_options, common);
  if (*runner) return RunPlayer(players.simulation, common);
  if (*builder) return Run(stream_client::PlanBuilder(players.pits, common), common);
  if (*user) return RunUser(person, common);
  if (*accel)
    return Run(stream_client::PlanAccelerations(files.left, files.right, files.rate_hz, common),
               common);
  if (*insoles) return Run(stream_client::PlanInsoles(insoles_options, common), common);
  if (*boards) return Run(stream_client::PlanBoards(under, common), common);
  return Run(stream_client::PlanCorners(files.left, files.right, common), common);
}
