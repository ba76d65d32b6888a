#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/input.h"

/// For targets that read a stream of bytes, which may come in pieces of any length.
namespace footing::fuzz {

struct Decoded {
  std::vector<std::string> messages;  ///< Or frames, each written again.
  bool refused = false;

  bool operator==(const Decoded&) const = default;
};

struct Stream {
  std::string_view bytes;  ///< Owned by the fuzzer.
  Decoded decoded;
};

/// The stream behind the lengths of its pieces; in those it comes to the same messages as at once.
inline Stream CheckPieces(const std::uint8_t* data, std::size_t size,
                          Decoded (*at_once)(std::string_view),
                          Decoded (*in_pieces)(std::string_view, Input)) {
  Input input(data, size);
  const Bytes pieces = input.String();
  const Bytes rest = input.Rest();
  const std::string_view bytes(reinterpret_cast<const char*>(rest.data()), rest.size());
  Stream stream{bytes, at_once(bytes)};
  Expect(stream.decoded == in_pieces(bytes, Input(pieces.data(), pieces.size())));
  return stream;
}

}  // namespace footing::fuzz
