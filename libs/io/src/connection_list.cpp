// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "connection_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace holdfast::io {
namespace {

/// The sort key of a connection: a load ratio that is not a number counts as infinite.
double rank(const verdict::ConnectionResult& result) {
  return std::isnan(result.load_ratio) ? std::numeric_limits<double>::infinity()
                                       : result.load_ratio;
}

}  // namespace

std::vector<std::size_t> most_loaded(const verdict::Assessment& assessment, std::size_t count) {
  std::vector<std::size_t> order(assessment.connections.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  count = std::min(count, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      const double ratio_a = rank(assessment.connections[a]);
                      const double ratio_b = rank(assessment.connections[b]);
                      return ratio_a != ratio_b ? ratio_a > ratio_b : a < b;
                    });
  order.resize(count);
  return order;
}

ConnectionList::ConnectionList(const verdict::Assessment& assessment,
                               const ConnectionChoice& choice) {
  switch (choice.kind) {
    case ConnectionChoice::Kind::kAll:
      size_ = assessment.connections.size();
      return;
    case ConnectionChoice::Kind::kBroken:
      indices_ = assessment.broken;
      break;
    case ConnectionChoice::Kind::kLargest:
      indices_ = most_loaded(assessment, choice.count);
      break;
  }
  size_ = indices_.size();
}

std::optional<ConnectionChoice> find_connection_choice(std::string_view text) {
  using Kind = ConnectionChoice::Kind;
  if (text == "all" || text == "broken") {
    return ConnectionChoice{.kind = text == "all" ? Kind::kAll : Kind::kBroken};
  }
  ConnectionChoice choice{.kind = Kind::kLargest};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), choice.count);
  const bool is_read = fault == std::errc() && end == text.data() + text.size();
  return is_read ? std::optional(choice) : std::nullopt;
}

}  // namespace holdfast::io
