#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/study/report/trials.h"
#include "common/base/result.h"
#include "common/recording/recorded_motion.h"
#include "common/recording/recorded_session.h"

namespace footing::study::bundle {

/// The numbers that stand for participants' codes in an exported data set, in random order. They
/// are kept in a file outside the data set, readable by its owner alone, so that another export
/// gives the same numbers. Without that file nobody knows who is who.
class ParticipantKey {
 public:
  /// A file's text: a header, then "NUMBER,CODE" a line. InvalidData that names file and line.
  static Result<ParticipantKey> Parse(std::string_view text, const std::string& file);

  /// Gives codes that have no number yet the next ones; `seed` decides which gets which.
  void Add(std::vector<std::string> codes, std::uint64_t seed);

  /// "sub-07". The code must have a number.
  std::string SubjectOf(const std::string& code) const;
  std::string Text() const;

 private:
  std::map<std::string, std::size_t> number_of_;
};

/// A table of a data set with its codebook: what each column means, by its name.
struct DocumentedTable {
  std::string tsv;
  nlohmann::ordered_json codebook;
};

/// One row for each participant.
DocumentedTable ParticipantsTable(const std::vector<records::Records>& people,
                                  const ParticipantKey& key);
/// One row for each participant, a column for each item and interface; free text only `with_text`.
DocumentedTable SurveyTable(const std::vector<records::Records>& people, const ParticipantKey& key,
                            bool with_text);
/// One row for each attempt; `file_of` gives the stem of its motion files by trial, "" where there
/// is no recording.
DocumentedTable TrialsTable(const std::vector<records::Records>& people, const ParticipantKey& key,
                            const std::map<const records::Trial*, std::string>& file_of);

/// Motion that a recording has of its trial, from the trial's first frame on; only devices that
/// have a role. InvalidData when the recording has no marks of a trial, or no frame of it.
Result<bids::RecordedMotion> ReadTrial(const recording::RecordedSession& session,
                                       const records::Trial& trial);

/// Configuration of footing-sim (EffectiveConfig of the protocol) without parts that may name a
/// person, a place or a file: addresses, paths, the client that gave a table, and the person and
/// date of a measured table. `features` are those of footingd, which publishes a config only if
/// they are not the best ones. Null: `json` is not such a config.
nlohmann::ordered_json AnonymousConfig(const std::string& json, const std::string& sensor_json);

}  // namespace footing::study::bundle
