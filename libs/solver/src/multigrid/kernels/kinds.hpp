// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "multigrid/kernels/vectors.hpp"

namespace holdfast::solver {

/// The kinds of the nodes of cubes, each stored once: a million nodes have a few dozen.
class Kinds {
 public:
  Kinds() = default;

  explicit Kinds(const std::vector<Kind>& by_node) : number_(by_node.size()) {
    for (std::size_t node = 0; node < by_node.size(); ++node) {
      const bool is_last = node > 0 && by_node[node] == by_node[node - 1];
      number_[node] = is_last ? number_[node - 1] : number_of(by_node[node]);
    }
  }

  const Kind& operator[](std::size_t node) const { return list_[number_[node]]; }

  void set(std::size_t node, const Kind& kind) { number_[node] = number_of(kind); }

  /// Node -> place in list().
  const std::uint32_t* numbers() const { return number_.data(); }

  std::uint32_t number(std::size_t node) const { return number_[node]; }

  /// All kinds that nodes have or had. It grows at its end only.
  const std::vector<Kind>& list() const { return list_; }

 private:
  std::uint32_t number_of(const Kind& kind) {
    const auto [found, is_new] = known_.try_emplace(std::bit_cast<std::uint64_t>(kind),
                                                    static_cast<std::uint32_t>(list_.size()));
    if (is_new) {
      list_.push_back(kind);
    }
    return found->second;
  }

  std::vector<std::uint32_t> number_;
  std::vector<Kind> list_;
  std::unordered_map<std::uint64_t, std::uint32_t> known_;
};

}  // namespace holdfast::solver
