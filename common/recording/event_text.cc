#include "common/recording/event_text.h"

#include "common/base/text.h"

namespace footing::recording {

std::string EventText(const v1::Event& event) {
  if (event.kind() == v1::Event::KIND_MARKER) {
    const bool has_value = event.marker().has_value();
    return event.text() + (has_value ? " " + text::Shortest(event.marker().value()) : "");
  }
  const std::string name = v1::Event::Kind_Name(event.kind());
  return event.text().empty() ? name : name + ": " + event.text();
}

}  // namespace footing::recording
