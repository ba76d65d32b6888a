#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/study/anonymous.h"
#include "clients/study/report/trials.h"

namespace footing::study::bundle {

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

}  // namespace footing::study::bundle
