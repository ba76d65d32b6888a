#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace footing::study::plan {

/// How the orders of the interfaces are drawn.
enum class Order {
  kWilliams,  ///< Balanced: see WilliamsOrders.
  kRandom,    ///< An independent random order for each participant.
};

const char* Name(Order order);

/// The item of the exertion in journals and tables: a scale of its own beside the ratings.
inline constexpr const char* kExertionItem = "exertion";
inline constexpr int kLeastRating = 1, kMostRating = 5;  ///< Gait paper, section 8.1.
inline constexpr int kMostExertion = 10;                 ///< From 0: Borg's CR10 scale.

/// A question of final_survey.overall that is not answered by free text: a choice among the
/// session's interfaces.
inline constexpr const char* kPreferredItem = "preferred interface";

/// A survey of the protocol's file takes the place of all of this: what it does not list is not
/// asked.
struct Survey {
  /// Each is rated 1 to 5 (gait paper, section 8.1).
  std::vector<std::string> ratings = {"fun",         "ease of use", "stress",
                                      "familiarity", "immersion",   "like"};
  std::vector<std::string> questions = {"good", "bad"};  ///< Free text.
  bool exertion = true;  ///< After each interface: 0 (nothing at all) to 10, Borg's CR10 scale.
};

/// After the last interface, when all of them can be compared.
struct FinalSurvey {
  /// Asked of each interface, as in the gait paper ("after using all four interfaces, the subjects
  /// also completed a survey which required them to rank each interface").
  Survey items = {.exertion = false};
  bool each_interface = true;  ///< Otherwise `items` are asked once, about the whole study.
  /// Once; free text, but for kPreferredItem.
  std::vector<std::string> overall = {kPreferredItem, "remarks"};
};

/// Rests of the participants.
struct Rests {
  double between_s = 60;  ///< Before each interface but the first.
  /// After this time in motion (ActiveTime) the participant rests before they move again.
  double active_limit_min = 60;
  double after_limit_s = 300;  ///< How long. A rest of at least this counts, whatever it is for.
};

/// Requirements on the devices before a trial begins.
struct DeviceGate {
  double least_battery = 0.2;  ///< Share of a full battery.
  double least_rate_hz = 30;   ///< Least rate of reports from each device that has a role.
  bool allow_simulated = false;
};

/// Settings of a study's interfaces.
struct InterfaceSettings {
  std::string turn_by = "head";  ///< Turn source of the interface leg: head, trunk or feet.
  /// Each participant's own ranges are measured before practice. Where that is given up, the table
  /// is the one of `tables` or the built-in one.
  bool personal_ranges = false;
  bool camera_roll = false;  ///< With the interface leg: the picture rolls with the head.
  /// Files of mapping tables by interface, such as a group's; beside the protocol.
  std::map<std::string, std::string> tables;
};

/// A study as its file says; docs/studies.md describes the keys. Defaults follow the gait paper,
/// section 8.1, where it says something.
struct Protocol {
  std::string name;
  std::vector<std::string> participants;  ///< Codes, never names.
  std::vector<std::string> interfaces;    ///< Names of stream::UserInterface.
  std::string control;                    ///< The interface that the others are compared with.
  Order order = Order::kWilliams;
  std::uint64_t seed = 0;
  std::string consent = "The participant has read and signed the consent form.";
  double practice_s = 300;
  Rests rests;
  double trial_limit_s = 600;  ///< A trial that takes longer is stopped.
  std::string practice_track = "endless";
  std::string straight_track = "straight";
  std::uint64_t straight_trials = 2;        ///< For each interface.
  std::vector<std::string> straight_tasks;  ///< Tasks of the track; empty: it has none.
  std::vector<std::string> test_tracks = {"1", "2", "3", "4"};
  InterfaceSettings settings;
  Survey survey;
  FinalSurvey final_survey;
  DeviceGate devices;
  double disk_mb = 500;  ///< Free space that a session needs.
};

/// A participant's code names folders and trials; kCodeRule says of which form it is.
bool IsCode(const std::string& code);
inline constexpr const char* kCodeRule =
    "a code is 1 to 16 letters, digits, - and _, and never a person's name";

/// Reads a protocol; comments are allowed. `file` names it in errors, which are InvalidData and say
/// which key has which value and what it may be.
Result<Protocol> ParseProtocol(const std::string& text, const std::string& file);

/// Reads the keys of a JSON object. The first fault is kept; its message names file, key, value and
/// what is allowed. A key that is missing leaves the value as it is.
class Reader {
 public:
  /// `place` names the object in messages: the file, or "FILE: survey".
  Reader(const nlohmann::ordered_json& object, std::string place);

  void Text(const std::string& key, std::string& value);
  void Flag(const std::string& key, bool& value);
  void Number(const std::string& key, double& value, double least, double greatest);
  void Whole(const std::string& key, std::uint64_t& value, std::uint64_t least,
             std::uint64_t greatest);
  /// A list of different texts; `least` to `greatest` of them.
  void Texts(const std::string& key, std::vector<std::string>& value, std::size_t least,
             std::size_t greatest);
  /// An object of its own; null when the key is missing.
  const nlohmann::ordered_json* Object(const std::string& key);
  void Require(const std::string& key);
  void Fail(const std::string& key, const std::string& what);

  /// The first fault; a key that nothing above has read is one.
  Result<void> Finish();

 private:
  const nlohmann::ordered_json* Find(const std::string& key);
  void Wrong(const std::string& key, const nlohmann::ordered_json& value,
             const std::string& allowed);

  const nlohmann::ordered_json& object_;
  std::string place_;
  std::vector<std::string> known_;
  std::optional<Error> fault_;
};

/// Scale on which a survey's item is answered.
enum class SurveyScale {
  kRating,    ///< 1 to 5.
  kExertion,  ///< 0 to 10.
  kText,      ///< One line.
  kChoice,    ///< One of `choices`.
};

/// One question of a survey.
struct SurveyItem {
  std::string interface;  ///< Empty: about the whole study.
  std::string item;       ///< Item to rate, or the question; "exertion" for the exertion.
  SurveyScale scale = SurveyScale::kRating;
  bool at_end = false;  ///< Asked after the last interface.
  std::vector<std::string> choices = {};

  bool operator==(const SurveyItem&) const = default;
};

/// Items asked right after an interface, in this order.
std::vector<SurveyItem> ItemsAfter(const Protocol& protocol, const std::string& interface);

/// Items asked at the end. Each item is asked of every interface, in the order in which they were
/// used, before the next item: so they are compared with each other.
std::vector<SurveyItem> ItemsAtEnd(const Protocol& protocol,
                                   const std::vector<std::string>& interfaces);

}  // namespace footing::study::plan
