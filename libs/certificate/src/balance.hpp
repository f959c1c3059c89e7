// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "statics.hpp"

/// Makes forces that balance exactly from displacements: the springs' forces, and what they leave
/// over, which is passed down to the supports beam by beam.
namespace holdfast::certificate {

/// The forces that belong to a field, and how far the two are apart.
struct Balance {
  std::vector<Six> beam;   ///< s, by beam.
  std::vector<Six> facet;  ///< s of the springs, by facet.
  std::vector<Six> hold;   ///< The gap of the facet's springs: less than facet_gap() by how far an
                           ///< edge or corner lifts (kUnilateral).
  std::vector<Integer> follower;  ///< By facet: what follows its pressure (kRegularised).
  std::vector<Six> rest;          ///< By module: what the springs leave unbalanced.
  std::string fault;              ///< Why the forces are not admissible, or empty.
};

class Balancer {
 public:
  Balancer(const Certificate& certificate, const Structure& structure, const Constants& constants);

  /// The springs' forces; `rest` is not passed on yet.
  Balance from_springs(std::size_t field) const;

  /// Passes the rest down to the supports. Then everything balances, in integers.
  void close(Balance& balance) const;

  /// An upper bound of the root of the sum of (s - h w)^2 / h.
  double mismatch(const Balance& balance, std::size_t field) const;

  /// An upper bound of the root of the sum of s^2 / h.
  double magnitude(const Balance& balance) const;

  /// The springs of a facet in its state; those of an open one under kUnilateral are void.
  Springs facet_springs(const State& state) const;

 private:
  const State& state_of(std::size_t facet) const {
    return certificate_.modules[structure_.facets()[facet]].state;
  }

  void press(std::size_t facet, const Six& gap, Balance& balance) const;
  void press_edge(std::size_t facet, const Six& gap, Balance& balance) const;
  void follow(std::size_t facet, std::size_t field, const Six& gap, Balance& balance) const;

  const Certificate& certificate_;
  const Structure& structure_;
  const Constants& constants_;
  std::vector<std::size_t> field_of_facet_;  ///< Of facets that tilt.
};

}  // namespace holdfast::certificate
