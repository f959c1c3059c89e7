// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/near_miss.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace holdfast::io {
namespace {

constexpr std::size_t kSlipLengthMin = 4;
constexpr std::size_t kSecondSlipLengthMin = 8;
constexpr std::size_t kSlipsMax = 2;

char small(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The name in small letters and digits only, as people remember it.
std::string folded(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c != '_' && c != '-' && c != ' ') {
      plain += small(c);
    }
  }
  return plain;
}

/// The words between '_' in the order of the alphabet.
std::vector<std::string_view> words_of(std::string_view name) {
  std::vector<std::string_view> words;
  for (std::size_t end = name.find('_'); end != std::string_view::npos; end = name.find('_')) {
    words.push_back(name.substr(0, end));
    name.remove_prefix(end + 1);
  }
  words.push_back(name);
  std::ranges::sort(words);
  return words;
}

/// Letters changed, added, left out or exchanged with the next one: the restricted distance of
/// [Damerau 1964], row by row of its table. kSlipsMax + 1 for all that is further.
std::size_t slips(std::string_view a, std::string_view b) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > kSlipsMax) {
    return kSlipsMax + 1;
  }
  std::array<std::vector<std::size_t>, 3> rows;
  rows.fill(std::vector<std::size_t>(b.size() + 1));
  auto& [before, last, row] = rows;
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::size_t slips_allowed(std::size_t length) {
  return length < kSlipLengthMin ? 0 : length < kSecondSlipLengthMin ? 1 : 2;
}

}  // namespace

std::optional<std::string_view> known_spelling(std::string_view name, Names known) {
  auto found = std::ranges::find(known, name);
  if (found == known.end()) {
    found = std::ranges::find_if(known, [&](std::string_view candidate) {
      return std::ranges::equal(name, candidate, {}, small, small);
    });
  }
  return found == known.end() ? std::nullopt : std::optional(*found);
}

std::optional<std::string_view> near_miss(std::string_view name, Names known) {
  if (std::ranges::find(known, name) != known.end()) {
    return std::nullopt;
  }
  const std::string plain = folded(name);
  std::optional<std::string_view> nearest;
  std::size_t slips_least = kSlipsMax + 1;
  for (const std::string_view candidate : known) {
    const std::string like = folded(candidate);
    const bool lacks_unit = plain.size() >= kSlipLengthMin && candidate.starts_with(name) &&
                            (candidate[name.size()] == '_' || candidate[name.size()] == '-');
    const bool is_the_same =
        lacks_unit || (name.size() == candidate.size() && words_of(name) == words_of(candidate));
    const std::size_t count = is_the_same ? 0 : slips(plain, like);
    if (count <= slips_allowed(like.size()) && count < slips_least) {
      nearest = candidate;
      slips_least = count;
    }
  }
  return nearest;
}

std::string did_you_mean(std::string_view known) {
  return "did you mean '" + std::string(known) + "'?";
}

}  // namespace holdfast::io
