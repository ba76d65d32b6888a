#pragma once

#include <cstdint>

#include "clients/view/scene/update.h"
#include "footing/v1/session.pb.h"

namespace footing::view {

/// A tick as plain structs. Stamps of the server's clock are moved by -offset_ns onto the viewer's
/// own. Numbers that are not finite become 0 on the way.
scene::Update Translate(const v1::Tick& tick, int source, std::int64_t received_ns,
                        std::int64_t offset_ns);

/// What slows a server or this session, as a note.
scene::Update TranslateNotice(const v1::Notice& notice, int source, std::int64_t received_ns);

}  // namespace footing::view
