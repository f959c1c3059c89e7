// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/agent.hpp"

#include "clusters.hpp"
#include "equilibrium.hpp"
#include "guard.hpp"
#include "remote.hpp"
#include "rounds.hpp"
#include "sweep.hpp"
#include "watch.hpp"
#include "waves.hpp"
#include "work.hpp"

namespace holdfast::agent {

template class BasicAgent<float>;
template class BasicAgent<double>;

}  // namespace holdfast::agent
