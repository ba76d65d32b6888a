#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// In which order participants use the interfaces.
namespace footing::study::plan {

/// Orders of the conditions 0 to count - 1.
using Orders = std::vector<std::vector<std::size_t>>;

/// The Latin square of Williams (1949): every condition equally often at each position, and equally
/// often right after each other one. An even count needs `count` rows, an odd one twice as many.
Orders WilliamsOrders(std::size_t count);

/// An order for each participant from whole squares: the rows of each square come in random order
/// and the conditions are dealt to its columns at random.
Orders BalancedOrders(std::size_t count, std::size_t participants, std::uint64_t seed);

/// An independent random order for each participant.
Orders RandomOrders(std::size_t count, std::size_t participants, std::uint64_t seed);

}  // namespace footing::study::plan
