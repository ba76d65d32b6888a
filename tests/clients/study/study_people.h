#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "clients/study/report/analysis.h"
#include "clients/study/report/trials.h"

/// The records of a small study.
namespace footing::study::report {

/// Wrist and joystick, the control.
inline plan::Protocol Two() {
  plan::Protocol protocol;
  protocol.name = "a <b> study";
  protocol.interfaces = {"wrist", "joystick"};
  protocol.control = "joystick";
  protocol.seed = 4;
  return protocol;
}

/// On the test track, with as many failures in curves.
inline records::Trial Test(const std::string& participant, const std::string& interface,
                           double time_s, std::size_t curves) {
  records::Trial trial;
  trial.participant = participant;
  trial.phase = interface + ".test";
  trial.interface = interface;
  trial.kind = "test_track";
  trial.outcome = "finished";
  trial.time_s = time_s;
  trial.failures.resize(curves, {1, "curve", 1, 1, false});
  return trial;
}

/// With the joystick everybody fails two times more and takes 10 s longer.
inline std::vector<records::Records> People(int count) {
  std::vector<records::Records> people;
  for (int i = 0; i < count; ++i) {
    records::Records& person = people.emplace_back();
    person.participant = "P" + std::to_string(i);
    person.finished = true;
    const auto failures = static_cast<std::size_t>(i % 3);
    person.trials = {Test(person.participant, "wrist", 50 + i, failures),
                     Test(person.participant, "joystick", 60 + i, failures + 2)};
    person.ratings = {{person.participant, "wrist", "fun", 4, false},
                      {person.participant, "joystick", "fun", 2, false}};
  }
  return people;
}

/// A measure of an analysis; null: there is none.
inline const nlohmann::ordered_json& Find(const Analysis& analysis, const std::string& id) {
  static const nlohmann::ordered_json none;
  for (const auto& one : analysis.json["measures"]) {
    if (one["id"] == id) return one;
  }
  return none;
}

}  // namespace footing::study::report
