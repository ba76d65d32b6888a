#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::StudyState&) {
  FOOTING_FIELD(study);
  FOOTING_FIELD(participant);
  FOOTING_FIELD(interface);
  FOOTING_FIELD(phase);
  FOOTING_FIELD(number);
  FOOTING_FIELD(phases);
  FOOTING_FIELD(doing);
  FOOTING_FIELD(next);
  FOOTING_FIELD(keys);
  FOOTING_FIELD(left_s);
  FOOTING_FIELD(active_s);
  FOOTING_FIELD(attempt);
  FOOTING_ENUM(StudyActivity, activity);
}
FOOTING_BOTH_WAYS(StudyState)

}  // namespace footing::wire
