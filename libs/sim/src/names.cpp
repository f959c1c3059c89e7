// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/sim/fault.hpp"
#include "holdfast/sim/simulation_result.hpp"

namespace holdfast::sim {

std::string_view name(agent::Phase phase) {
  switch (phase) {
    case agent::Phase::kDiscovery:
      return "discovery";
    case agent::Phase::kCoordinates:
      return "coordinates";
    case agent::Phase::kElection:
      return "election";
    case agent::Phase::kTree:
      return "tree";
    case agent::Phase::kMass:
      return "mass";
    case agent::Phase::kSimplified:
      return "simplified";
    case agent::Phase::kEquilibrium:
      return "equilibrium";
    case agent::Phase::kModel:
      return "model";
    case agent::Phase::kOverload:
      return "overload";
    case agent::Phase::kDone:
      break;
  }
  return "done";
}

std::string_view name(Fault::Kind kind) {
  switch (kind) {
    case Fault::Kind::kKill:
      return "kill";
    case Fault::Kind::kCut:
      return "cut";
    case Fault::Kind::kDetach:
      return "detach";
    case Fault::Kind::kReset:
      return "reset";
    case Fault::Kind::kMend:
      return "mend";
    case Fault::Kind::kUnplug:
      return "unplug";
    case Fault::Kind::kPlug:
      return "plug";
    case Fault::Kind::kAttach:
      break;
  }
  return "attach";
}

}  // namespace holdfast::sim
