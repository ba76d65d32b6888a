#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace footing::study::bundle {

/// What footing-sim ran with (EffectiveConfig of the protocol) without what may name a person, a
/// place or a file: addresses, paths, the client that gave a table, and of a measured table whom
/// and when it was measured of. Null: the text is not such a config.
nlohmann::ordered_json AnonymousConfig(const std::string& json);

}  // namespace footing::study::bundle
