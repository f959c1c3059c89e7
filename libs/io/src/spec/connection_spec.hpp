// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "holdfast/io/document.hpp"

/// Translates what a file says of connections: the laws of connectors, and single connections.
namespace holdfast::io {

/// Gives a connector in a direction of the lattice what a file says of it.
void apply(const Connectors& connectors, const base::Lattice& lattice, std::size_t direction,
           model::ConnectorLaw& law);

/// Whether a document says of single pairs of neighbours that they are open, or how they hold, or
/// has bodies.
bool has_connections(const Document& document);

/// All cells in which modules are or come by steps; none where has_connections() is false.
std::set<base::Cell> cells_of(const Document& document);

/// Releases the pairs of neighbours that a document leaves open, and gives connections laws of
/// their own, as far as both modules are in `cells`. `kinds` are those of the document, the one of
/// all other modules first. Errors: a pair that is none, in which no module ever is, or that is
/// named twice.
std::optional<base::Error> add_connections(const Document& document,
                                           const std::vector<model::ModuleKind>& kinds,
                                           const std::set<base::Cell>& cells,
                                           model::RobotSpec& spec);

}  // namespace holdfast::io
