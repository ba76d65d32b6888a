#pragma once

#include <cstddef>

namespace footing::transport {

/// Enlarges this process's table to hold `count` descriptors, as far as its limit of open files
/// permits. The kernel doubles the table when a descriptor does not fit, and where a process has
/// threads it then waits until every processor has passed a quiet point: the thread that accepts
/// the 257th connection would be stopped for 6 to 17 ms.
void ReserveDescriptors(std::size_t count);

}  // namespace footing::transport
