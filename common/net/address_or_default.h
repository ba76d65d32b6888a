#pragma once

#include "common/net/address.h"

namespace footing::transport {

/// The address that an option of a client gives, or DefaultAddress(name) where its text is empty.
inline Result<Address> AddressOrDefault(const std::string& text, const std::string& name) {
  return text.empty() ? Result<Address>(DefaultAddress(name)) : ParseAddress(text);
}

}  // namespace footing::transport
