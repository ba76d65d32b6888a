#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

constexpr double kFrameWithinS = 3;
constexpr double kLeaseS = 1;  // It is released at once.

/// The holder that the newest frame names; empty: nobody.
Result<std::string> ReadHolder(Session& session) {
  std::optional<std::string> holder;
  session.set_on_tick([&](const v1::Tick& tick) {
    if (tick.has_characters()) holder = tick.characters().lease_holder();
  });
  const Waited waited = session.RunUntil([&] { return holder.has_value(); }, kFrameWithinS);
  session.set_on_tick(nullptr);
  if (waited == Waited::kInterrupted) return Failure("stopped");
  if (!holder) return Failure("footing-sim publishes no frames: " + session.link());
  return std::move(*holder);
}

/// Takes the lease from whoever has it, and gives it back, so that anybody may take it.
Result<void> TakeOver(Session& session) {
  v1::Command take;
  take.mutable_take_lease()->set_holder(cli::UserAtHost() + ", footing-ctl");
  take.mutable_take_lease()->set_seconds(kLeaseS);
  take.mutable_take_lease()->set_take_over(true);
  if (const auto taken = session.Call(std::move(take)); !taken) return taken.error();
  v1::Command release;
  release.mutable_release_lease();
  if (const auto released = session.Call(std::move(release)); !released) return released.error();
  return {};
}

Result<void> RunLease(bool take_over, const Shared& shared) {
  const auto session = OpenSimulation(shared, {"skeletons", "characters"}, "footing-sim");
  if (!session) return session.error();
  if ((*session)->welcome().server_id() == "footingd") {
    return UsageError(
        "lease: this address is footingd's; connect to footing-sim, or, to take over the lease of "
        "footingd, add --of footingd --take-over");
  }
  const auto holder = ReadHolder(**session);
  if (!holder) return holder.error();
  if (take_over) {
    if (const auto done = TakeOver(**session); !done) return done;
  }
  Print({{"holder", take_over ? "" : *holder}, {"taken_from", take_over ? *holder : ""}},
        holder->empty() ? "nobody has the lease"
        : take_over     ? "the lease was taken over from " + *holder + "; now nobody has it"
                        : *holder + " has the lease",
        shared);
  return {};
}

Result<void> TakeOverFootingd(bool take_over, const Shared& shared) {
  if (!take_over) {
    return UsageError(
        "lease: footingd does not publish who has its lease; a command that it refuses names the "
        "holder. To take the lease over add --take-over");
  }
  const auto session = Open(shared);
  if (!session) return session.error();
  if (const auto done = TakeOver(**session); !done) return done;
  Print({{"holder", ""}}, "the lease of footingd was taken over; now nobody has it", shared);
  return {};
}

}  // namespace

void AddLeaseCommand(CLI::App& app, Shared& shared) {
  const auto take_over = std::make_shared<bool>(false);
  const auto of = std::make_shared<std::string>("footing-sim");
  CLI::App* command = app.add_subcommand(
      "lease", "Print who holds the lease of footing-sim, or take over a server's lease");
  command
      ->add_option("--of", *of,
                   "Server of the lease; that of footingd can be taken over, not printed")
      ->check(CLI::IsMember({"footing-sim", "footingd"}))
      ->capture_default_str();
  command->add_flag("--take-over", *take_over,
                    "Take the lease from its holder: a study that has it stops");
  command->footer(
      "Examples (connect to footing-sim, or with --of to footingd):\n"
      "  footing-ctl lease\n"
      "  footing-ctl lease --take-over\n"
      "  footing-ctl lease --of footingd --take-over");
  command->callback([take_over, of, &shared] {
    const auto done =
        *of == "footingd" ? TakeOverFootingd(*take_over, shared) : RunLease(*take_over, shared);
    if (!done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

}  // namespace footing::ctl
