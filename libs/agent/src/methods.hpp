// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/wire/wire.hpp"

/// Does the program have all methods (method.hpp)? One with HOLDFAST_AGENT_ONE_SWEEP_ONLY, for
/// modules with little flash, has elimination and the polynomial: what takes one sweep an iteration
/// and needs no more memory or code than they do. All modules of such a robot must be told,
/// Setup::only_one_sweep. What the root does with other methods, and their messages, is left out.
namespace holdfast::agent {

#ifdef HOLDFAST_AGENT_ONE_SWEEP_ONLY
inline constexpr bool kHasAllMethods = false;
#else
inline constexpr bool kHasAllMethods = true;
#endif

/// Can a verdict be renewed from what is kept (conductor/renewal.hpp)? It takes 6 KB of flash, and
/// is left out with HOLDFAST_AGENT_STARTS_AFRESH: every change is a new round then.
#ifdef HOLDFAST_AGENT_STARTS_AFRESH
inline constexpr bool kKeepsAnswers = false;
#else
inline constexpr bool kKeepsAnswers = true;
#endif

/// Does an iteration go along what is kept, if anything is?
constexpr bool is_deflated(wire::Operation operation) {
  return kKeepsAnswers && (operation == wire::Operation::kIterateDeflated ||
                           operation == wire::Operation::kIterateLast);
}

/// Is this an iteration of the polynomial?
constexpr bool is_iterate(wire::Operation operation) {
  return operation == wire::Operation::kIterate || is_deflated(operation);
}

/// Does an equilibrium begin from what is kept?
constexpr bool is_resume(wire::Operation operation) {
  return kKeepsAnswers &&
         (operation == wire::Operation::kResume || operation == wire::Operation::kResumeDeflated);
}

/// Can free faces be judged (free_faces.hpp)? Left out together with the above.
inline constexpr bool kJudgesFaces = kKeepsAnswers;

/// Are further solutions of the regularised law sought (conductor/seeking.hpp)? Left out together
/// with fronts.
inline constexpr bool kSeeksOthers = kHasAllMethods;

}  // namespace holdfast::agent
