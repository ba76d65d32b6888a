#include "common/camera/preview.h"

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "tests/fuzz/input.h"
#include "tests/fuzz/pieces.h"

/// Bytes of a camera program: in pieces of any length they come to the same messages as at once;
/// every number is one that can be drawn, and a message that is written again is read as the same.
namespace footing::fuzz {
namespace {

std::string Written(const preview::Message& message) {
  if (const auto* refusal = std::get_if<preview::Refusal>(&message)) {
    return preview::EncodeRefusal(refusal->why);
  }
  return preview::Encode(std::get<preview::Picture>(message));
}

void CheckCircle(const preview::Circle& circle) {
  for (const float length : {circle.u_px, circle.v_px, circle.radius_px})
    Expect(std::isfinite(length) && length >= 0);
}

void Check(const preview::Message& message) {
  const auto* picture = std::get_if<preview::Picture>(&message);
  if (picture == nullptr) return Expect(std::get<preview::Refusal>(message).why.size() <= 512);
  Expect(picture->rgb.size() == std::size_t{3} * static_cast<std::size_t>(picture->width) *
                                    static_cast<std::size_t>(picture->height));
  for (const preview::Sphere& sphere : picture->spheres) {
    CheckCircle(sphere.circle);
    Expect(sphere.confidence >= 0 && sphere.confidence <= 1 && std::isfinite(sphere.range_m));
  }
  for (const preview::RefusedLight& light : picture->refused) CheckCircle(light.circle);
}

/// Whole messages of a reader, behind those taken before; false when it refuses.
void TakeAll(preview::PreviewReader& reader, Decoded& taken) {
  while (!taken.refused) {
    const auto next = reader.Next();
    taken.refused = !next.ok();
    if (taken.refused || !next->has_value()) return;
    Check(**next);
    taken.messages.push_back(Written(**next));
  }
}

Decoded AtOnce(std::string_view bytes) {
  preview::PreviewReader reader;
  Decoded taken;
  reader.Add(bytes);
  TakeAll(reader, taken);
  return taken;
}

Decoded InPieces(std::string_view bytes, Input pieces) {
  preview::PreviewReader reader;
  Decoded taken;
  while (!bytes.empty() && !taken.refused) {
    const std::string_view piece = bytes.substr(0, 1 + pieces.Byte() * std::size_t{4});
    reader.Add(piece);
    TakeAll(reader, taken);
    bytes.remove_prefix(piece.size());
  }
  return taken;
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  const fuzz::Decoded whole = fuzz::CheckPieces(data, size, fuzz::AtOnce, fuzz::InPieces).decoded;
  std::string again;
  for (const std::string& message : whole.messages) again += message;
  const fuzz::Decoded repeated = fuzz::AtOnce(again);
  fuzz::Expect(!repeated.refused && repeated.messages == whole.messages);
  return 0;
}
