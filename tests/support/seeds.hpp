// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// How many robots a campaign tries. The build that users get tries all of them. Sanitizers, under
// which a robot takes ten to twenty times as long, look for accesses and operations that no robot
// may make, and WebAssembly for what another library and 32 bits change; both find it in the first
// few of a kind. What is right is the other build's question.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace holdfast::test {

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HOLDFAST_TEST_SHORT 1
#endif
#endif
#if defined(HOLDFAST_TEST_SHORT) || defined(__SANITIZE_ADDRESS__) || defined(__EMSCRIPTEN__)
inline constexpr bool kIsShort = true;
#else
inline constexpr bool kIsShort = false;
#endif

/// Returns `all`, a number of robots or one in `share` of it where
/// campaigns are short.
template <class Count>
constexpr Count campaign(Count all, Count share = 4) {
  return kIsShort ? std::max(all / share, Count{1}) : all;
}

/// Returns how many of what a campaign counts there must be at least, `all` of them in the build
/// that users get. The first few robots of a short campaign are no fair share of it, so that it
/// must only reach what a count of that mean falls short of by chance in one of a thousand: three
/// times its root below the mean, which is nothing for a small one.
template <class Count>
constexpr Count least(Count all, Count share = 4) {
  const Count mean = campaign(all, share);
  Count root{};
  while ((root + 1) * (root + 1) <= 9 * mean) {
    ++root;
  }
  return !kIsShort ? all : root < mean ? mean - root : Count{};
}

/// Every how many-th of a list is tried; where it is short every `share`-th.
constexpr int every(int share) { return kIsShort ? share : 1; }

/// A list of robots, or of what is done with them; where it is short the first of it, a share.
template <class Item>
std::vector<Item> campaign(std::initializer_list<Item> all, std::size_t share = 4) {
  return std::vector<Item>(all.begin(), all.begin() + campaign(all.size(), share));
}

}  // namespace holdfast::test
