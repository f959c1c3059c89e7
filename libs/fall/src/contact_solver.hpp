// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "contacts.hpp"

namespace holdfast::fall {

/// Gives the bodies of all contacts the impulses with which none comes nearer than its gap within a
/// step, by Coulomb's law and without restitution: projected Gauss-Seidel iterations.
void apply_impulses(const std::vector<Contact>& contacts, double friction, double step_s);

/// Takes bodies out of each other, slowly.
void push_apart(const std::vector<Contact>& contacts);

}  // namespace holdfast::fall
