#pragma once

namespace footing::test {

/// False under a sanitizer, which brings its own malloc.
bool CountsAllocations();
/// Allocations of this process so far, MuJoCo's included; 0 when they are not counted.
long Allocations();

}  // namespace footing::test
