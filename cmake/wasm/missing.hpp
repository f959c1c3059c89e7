// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>
#include <version>

/// What holdfast uses of C++20 and Emscripten's libc++ 13 lacks: std::bit_cast and algorithms of
/// std::ranges. Included before every source of the wasm preset, nowhere else. Each algorithm
/// forwards to the one of namespace std.
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
namespace std {  // NOLINT(cert-dcl58-cpp)

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

}  // namespace std

namespace std::ranges {  // NOLINT(cert-dcl58-cpp)

namespace holdfast_detail {

/// Compares what a projection makes of two elements.
template <class Compare, class Projection>
constexpr auto by(Compare compare, Projection projection) {
  return [=](const auto& a, const auto& b) {
    return std::invoke(compare, std::invoke(projection, a), std::invoke(projection, b));
  };
}

template <class Predicate, class Projection>
constexpr auto on(Predicate predicate, Projection projection) {
  return [=](auto&& a) -> decltype(auto) {
    return std::invoke(predicate, std::invoke(projection, std::forward<decltype(a)>(a)));
  };
}

struct Identity {
  template <class T>
  constexpr T&& operator()(T&& value) const noexcept {
    return std::forward<T>(value);
  }
};

struct Less {
  template <class A, class B>
  constexpr bool operator()(const A& a, const B& b) const {
    return a < b;
  }
};

template <class Iterator>
struct Rest {
  Iterator first;
  Iterator last;

  Iterator begin() const { return first; }

  Iterator end() const { return last; }
};

}  // namespace holdfast_detail

template <class Range, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr void sort(Range&& range, Compare compare = {}, Projection projection = {}) {
  std::sort(std::begin(range), std::end(range), holdfast_detail::by(compare, projection));
}

template <class Range, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr void stable_sort(Range&& range, Compare compare = {}, Projection projection = {}) {
  std::stable_sort(std::begin(range), std::end(range), holdfast_detail::by(compare, projection));
}

template <class Range, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr bool is_sorted(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::is_sorted(std::begin(range), std::end(range),
                        holdfast_detail::by(compare, projection));
}

template <class Range>
constexpr auto unique(Range&& range) {
  const auto last = std::end(range);
  return holdfast_detail::Rest<decltype(std::begin(range))>{std::unique(std::begin(range), last),
                                                            last};
}

template <class Range>
constexpr void reverse(Range&& range) {
  std::reverse(std::begin(range), std::end(range));
}

template <class Range, class Predicate, class Projection = holdfast_detail::Identity>
constexpr bool all_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::all_of(std::begin(range), std::end(range),
                     holdfast_detail::on(predicate, projection));
}

template <class Range, class Predicate, class Projection = holdfast_detail::Identity>
constexpr bool any_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::any_of(std::begin(range), std::end(range),
                     holdfast_detail::on(predicate, projection));
}

template <class Range, class Predicate, class Projection = holdfast_detail::Identity>
constexpr bool none_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::none_of(std::begin(range), std::end(range),
                      holdfast_detail::on(predicate, projection));
}

template <class Range, class Function, class Projection = holdfast_detail::Identity>
constexpr void for_each(Range&& range, Function function, Projection projection = {}) {
  for (auto&& element : range) {
    std::invoke(function, std::invoke(projection, element));
  }
}

template <class Range, class Value, class Projection = holdfast_detail::Identity>
constexpr auto find(Range&& range, const Value& value, Projection projection = {}) {
  return std::find_if(std::begin(range), std::end(range), [&](const auto& element) {
    return std::invoke(projection, element) == value;
  });
}

template <class Range, class Predicate, class Projection = holdfast_detail::Identity>
constexpr auto find_if(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      holdfast_detail::on(predicate, projection));
}

template <class Range, class Compare = std::equal_to<>,
          class Projection = holdfast_detail::Identity>
constexpr auto adjacent_find(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::adjacent_find(std::begin(range), std::end(range),
                            holdfast_detail::by(compare, projection));
}

template <class RangeA, class RangeB, class Compare = std::equal_to<>,
          class ProjectionA = holdfast_detail::Identity,
          class ProjectionB = holdfast_detail::Identity>
constexpr bool equal(RangeA&& a, RangeB&& b, Compare compare = {}, ProjectionA project_a = {},
                     ProjectionB project_b = {}) {
  return std::equal(
      std::begin(a), std::end(a), std::begin(b), std::end(b), [&](const auto& x, const auto& y) {
        return std::invoke(compare, std::invoke(project_a, x), std::invoke(project_b, y));
      });
}

template <class Range, class Value, class Projection = holdfast_detail::Identity>
constexpr auto count(Range&& range, const Value& value, Projection projection = {}) {
  return std::count_if(std::begin(range), std::end(range), [&](const auto& element) {
    return std::invoke(projection, element) == value;
  });
}

template <class Range, class Predicate, class Projection = holdfast_detail::Identity>
constexpr auto count_if(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::count_if(std::begin(range), std::end(range),
                       holdfast_detail::on(predicate, projection));
}

template <class Range, class Value, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr auto lower_bound(Range&& range, const Value& value, Compare compare = {},
                           Projection projection = {}) {
  return std::lower_bound(std::begin(range), std::end(range), value,
                          [&](const auto& element, const Value& wanted) {
                            return std::invoke(compare, std::invoke(projection, element), wanted);
                          });
}

template <class Range, class Value, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr auto upper_bound(Range&& range, const Value& value, Compare compare = {},
                           Projection projection = {}) {
  return std::upper_bound(std::begin(range), std::end(range), value,
                          [&](const Value& wanted, const auto& element) {
                            return std::invoke(compare, wanted, std::invoke(projection, element));
                          });
}

template <class Range, class Predicate, class Projection = holdfast_detail::Identity>
constexpr auto partition_point(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::partition_point(std::begin(range), std::end(range),
                              holdfast_detail::on(predicate, projection));
}

template <class Range, class Value, class Compare = holdfast_detail::Less>
constexpr bool binary_search(Range&& range, const Value& value, Compare compare = {}) {
  return std::binary_search(std::begin(range), std::end(range), value, compare);
}

template <class Range, class Value, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr auto equal_range(Range&& range, const Value& value, Compare compare = {},
                           Projection projection = {}) {
  const auto first = lower_bound(range, value, compare, projection);
  return holdfast_detail::Rest<decltype(std::begin(range))>{
      first, upper_bound(range, value, compare, projection)};
}

template <class Range, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr auto min_element(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::min_element(std::begin(range), std::end(range),
                          holdfast_detail::by(compare, projection));
}

template <class Range, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr auto max_element(Range&& range, Compare compare = {}, Projection projection = {}) {
  return std::max_element(std::begin(range), std::end(range),
                          holdfast_detail::by(compare, projection));
}

/// Returns the extremes as values, where std::minmax_element returns their places.
template <class Range, class Compare = holdfast_detail::Less,
          class Projection = holdfast_detail::Identity>
constexpr auto minmax(Range&& range, Compare compare = {}, Projection projection = {}) {
  const auto [low, high] = std::minmax_element(std::begin(range), std::end(range),
                                               holdfast_detail::by(compare, projection));
  return std::pair(*low, *high);
}

template <class Range>
constexpr auto min(Range&& range) {
  return *std::min_element(std::begin(range), std::end(range));
}

template <class Range, class Output>
constexpr auto copy(Range&& range, Output output) {
  return std::copy(std::begin(range), std::end(range), output);
}

template <class Range, class Output, class Predicate>
constexpr auto copy_if(Range&& range, Output output, Predicate predicate) {
  return std::copy_if(std::begin(range), std::end(range), output, predicate);
}

template <class Range, class Output>
constexpr auto move(Range&& range, Output output) {
  return std::move(std::begin(range), std::end(range), output);
}

template <class Range, class Value>
constexpr void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
}

template <class Range, class Predicate>
constexpr auto stable_partition(Range&& range, Predicate predicate) {
  const auto last = std::end(range);
  return holdfast_detail::Rest<decltype(std::begin(range))>{
      std::stable_partition(std::begin(range), last, predicate), last};
}

template <class Range, class Predicate, class Value>
constexpr void replace_if(Range&& range, Predicate predicate, const Value& value) {
  std::replace_if(std::begin(range), std::end(range), predicate, value);
}

template <class Range, class Output, class Function>
constexpr auto transform(Range&& range, Output output, Function function) {
  return std::transform(
      std::begin(range), std::end(range), output,
      [&](auto&& element) -> decltype(auto) { return std::invoke(function, element); });
}

}  // namespace std::ranges
#endif
