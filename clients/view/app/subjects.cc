#include "clients/view/app/subjects.h"

#include "common/runtime/subject.h"

namespace footing::view {

Result<std::vector<v1::Command>> SubjectCommands(const std::vector<std::string>& files) {
  std::vector<v1::Command> commands;
  for (const std::string& file : files) {
    const auto subject = subject::ReadSubject(file);
    if (!subject) return subject.error();
    v1::SetSubject& set = *commands.emplace_back().mutable_set_subject();
    set.set_code(subject->code);
    set.set_height_m(subject->height_m);
    set.set_mass_kg(subject->mass_kg);
    set.set_foot_length_m(subject->foot_length_m);
  }
  return commands;
}

v1::Command TPoseCommand() {
  v1::Command command;
  command.mutable_calibrate_t_pose()->set_character(1);
  return command;
}

}  // namespace footing::view
