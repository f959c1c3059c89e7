// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "holdfast/io/document.hpp"

/// Checks the rigid pieces that a document names, and finds the connections inside them.
namespace holdfast::io {

/// The number of the body that each cell is in, of all cells of bodies.
class BodyIndex {
 public:
  explicit BodyIndex(const Document& document);

  /// The number of the body that both cells are in; none if there is none.
  std::optional<std::int32_t> inside(const model::CellPair& pair) const;

  /// The number of the body that a cell is in; none if there is none.
  std::optional<std::int32_t> body_at(const base::Cell& cell) const;

 private:
  std::map<base::Cell, std::int32_t> bodies_;
};

/// Finds the first fault of a document's bodies: a cell that is named twice, or in which no module
/// ever is; a body in several parts; one that does not come in one step, or leave in one; a step
/// that moves a part of one, takes its modules in any order, or parts it.
std::optional<base::Error> find_bodies_fault(const Document& document);

}  // namespace holdfast::io
