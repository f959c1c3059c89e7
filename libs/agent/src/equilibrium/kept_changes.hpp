// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/equilibrium/deflation.hpp"
#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"

/// A module's part in what deflation.hpp describes.
namespace holdfast::agent {

/// The root's part, or null.
Deflation* deflation_of(const Workspace& ws);

/// A neighbour of a module that has come says how it has moved: this one is to be in balance.
void hear_change(Workspace& ws, Direction face, int change, const base::Vec6<float>& theirs);

/// An equilibrium begins: where the last change is kept; the next one grows from nothing.
void begin_change(Workspace& ws, const Order& order);

/// The energies of the changes that are kept, one after the other: this one goes to all neighbours;
/// when theirs is here, its products with those before it and with itself.
void share_change(Workspace& ws, int change);
void weigh_change(Workspace& ws, int change);

/// Adds to the move of a node what an order asks for along the changes that are kept. The move is
/// part of the change that grows.
void move_along(Workspace& ws, const Order& order, int node, base::Vec6<double>& move);

/// Adds the products of the residual with each change to a report.
void report_along(const Workspace& ws, Report& report);

}  // namespace holdfast::agent
