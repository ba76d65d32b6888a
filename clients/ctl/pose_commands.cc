#include <memory>
#include <utility>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"
#include "common/runtime/subject.h"

namespace footing::ctl {
namespace {

Result<void> Send(const Shared& shared, v1::Command command) {
  return SendToSimulation(shared, std::move(command), "footing-sim --engine pose");
}

Result<void> TakeTPose(const Shared& shared) {
  v1::Command command;
  command.mutable_calibrate_t_pose()->set_character(1);
  if (const auto sent = Send(shared, std::move(command)); !sent) return sent;
  Print({{"t_pose", "awaited"}}, "stand still in the T-pose for five seconds", shared);
  return {};
}

Result<void> NextSubject(const std::string& file, const Shared& shared) {
  const auto subject = subject::ReadSubject(file);
  if (!subject) return subject.error();
  v1::Command command;
  v1::SetSubject& set = *command.mutable_set_subject();
  set.set_code(subject->code);
  set.set_height_m(subject->height_m);
  set.set_mass_kg(subject->mass_kg);
  set.set_foot_length_m(subject->foot_length_m);
  if (const auto sent = Send(shared, std::move(command)); !sent) return sent;
  Print({{"subject", subject->code}, {"t_pose", "awaited"}},
        subject->code + " is next: step on the boards and stand still in a T-pose for five seconds",
        shared);
  return {};
}

void Keep(const Result<void>& done, Shared& shared) {
  if (!done) shared.exit_code = cli::Report(done.error());
}

}  // namespace

void AddPoseCommands(CLI::App& app, Shared& shared) {
  CLI::App* t_pose = app.add_subcommand("t-pose", "Repeat the T-pose of the pose engine");
  t_pose->footer("Example:\n  footing-ctl t-pose   # connects to footing-sim");
  t_pose->callback([&shared] { Keep(TakeTPose(shared), shared); });

  const auto file = std::make_shared<std::string>();
  CLI::App* next = app.add_subcommand("subject", "Start the next subject of the pose engine");
  next->add_option("FILE", *file, "Subject file, JSON: code, height_m, mass_kg, foot_length_m")
      ->required();
  next->footer("Example:\n  footing-ctl subject p08.json   # connects to footing-sim");
  next->callback([file, &shared] { Keep(NextSubject(*file, shared), shared); });
}

}  // namespace footing::ctl
