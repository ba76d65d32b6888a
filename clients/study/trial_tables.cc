#include "clients/study/trial_tables.h"

#include <string>

namespace footing::study::bundle {
namespace {

std::string IdOf(const recording::RecordedSession& session) {
  for (const mcap::Metadata& one : session.metadata()) {
    const auto id = one.values.find("trial");
    if (one.name == "trial" && id != one.values.end()) return id->second;
  }
  return "";
}

}  // namespace

Result<bids::RecordedMotion> ReadTrial(const recording::RecordedSession& session,
                                       const records::Trial& trial) {
  bids::Choice choice{IdOf(session), {}, /*with_role=*/true};
  if (choice.trial.empty()) return InvalidData(session.path() + ": it has no trial marks");
  if (session.Find("footing-sim") == nullptr) {
    return InvalidData(session.path() + " has no messages of footing-sim");
  }
  for (const records::Failure& one : trial.failures) {
    if (one.undone) choice.undone.insert(one.number);
  }
  return ReadMotion(session, choice);
}

}  // namespace footing::study::bundle
