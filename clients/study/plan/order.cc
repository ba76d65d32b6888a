#include "clients/study/plan/order.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "clients/study/plan/draw.h"

namespace footing::study::plan {
namespace {

std::vector<std::size_t> UpTo(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

/// 0, 1, n - 1, 2, n - 2, ...: its neighbours' differences are all different when n is even.
std::vector<std::size_t> FirstRow(std::size_t count) {
  std::vector<std::size_t> row;
  for (std::size_t i = 0; i < count; ++i) {
    row.push_back(i == 0 ? 0 : i % 2 == 1 ? (i + 1) / 2 : count - i / 2);
  }
  return row;
}

}  // namespace

Orders WilliamsOrders(std::size_t count) {
  Orders orders;
  const std::vector<std::size_t> first = FirstRow(count);
  for (std::size_t shift = 0; shift < count; ++shift) {
    std::vector<std::size_t> row;
    for (const std::size_t condition : first) row.push_back((condition + shift) % count);
    orders.push_back(std::move(row));
  }
  if (count % 2 == 1 && count > 1) {
    for (std::size_t i = 0; i < count; ++i) {
      orders.emplace_back(orders[i].rbegin(), orders[i].rend());
    }
  }
  return orders;
}

Orders BalancedOrders(std::size_t count, std::size_t participants, std::uint64_t seed) {
  Orders orders;
  Draw draw(seed, "order");
  const Orders square = WilliamsOrders(count);
  while (orders.size() < participants) {
    std::vector<std::size_t> names = UpTo(count);
    std::vector<std::size_t> rows = UpTo(square.size());
    draw.Shuffle(names);
    draw.Shuffle(rows);
    for (const std::size_t row : rows) {
      if (orders.size() == participants) break;
      std::vector<std::size_t> order;
      for (const std::size_t condition : square[row]) order.push_back(names[condition]);
      orders.push_back(std::move(order));
    }
  }
  return orders;
}

Orders RandomOrders(std::size_t count, std::size_t participants, std::uint64_t seed) {
  Orders orders;
  for (std::size_t i = 0; i < participants; ++i) {
    std::vector<std::size_t> order = UpTo(count);
    Draw(seed, "order " + std::to_string(i)).Shuffle(order);
    orders.push_back(std::move(order));
  }
  return orders;
}

}  // namespace footing::study::plan
