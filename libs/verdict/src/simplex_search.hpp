// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace holdfast::verdict {

/// Minimises a function of a few numbers, which are those to begin with, in place, by a simplex
/// that is reflected, stretched and shrunk [Nelder, Mead 1965]; needs no slopes, and takes infinity
/// for what is not allowed. Returns the value there.
double minimise(const std::function<double(std::span<const double>)>& function,
                std::vector<double>& numbers);

}  // namespace holdfast::verdict
