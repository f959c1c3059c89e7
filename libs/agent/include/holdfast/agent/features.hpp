// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

/// What this program has. No other file of the room asks for a macro; all else asks for a constant
/// here, or for a pointer that is null and known to be so where the program has nothing to lend.
namespace holdfast::agent {

/// Does it know robots of all kinds: any lattice, supports, loads and laws of connections, and more
/// planned modules than five? A program with HOLDFAST_AGENT_FLOOR_ONLY knows cubes on a floor
/// alone.
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
inline constexpr bool kIsGeneral = false;
#else
inline constexpr bool kIsGeneral = true;
#endif

/// Does it have all methods, and does it seek further solutions of the regularised law? One with
/// HOLDFAST_AGENT_ONE_SWEEP_ONLY, for modules with little flash, has elimination and the
/// polynomial: what takes one sweep an iteration and needs no more memory or code than they do. All
/// modules of such a robot must be told, Setup::only_one_sweep. What the root does with other
/// methods, and their messages, is left out.
#ifdef HOLDFAST_AGENT_ONE_SWEEP_ONLY
inline constexpr bool kHasAllMethods = false;
#else
inline constexpr bool kHasAllMethods = true;
#endif

/// Can it renew a verdict from what is kept (conductor/renewal.hpp), judge the stages of a step and
/// free faces? That takes 6 KB of flash and more, and is left out with
/// HOLDFAST_AGENT_STARTS_AFRESH: every change is a new round then.
#ifdef HOLDFAST_AGENT_STARTS_AFRESH
inline constexpr bool kKeepsAnswers = false;
#else
inline constexpr bool kKeepsAnswers = true;
#endif

/// Does a table of 2,048 bytes make checksums fast? With HOLDFAST_AGENT_SMALL_CHECKSUM it has 32.
#ifdef HOLDFAST_AGENT_SMALL_CHECKSUM
inline constexpr bool kHasFastChecksum = false;
#else
inline constexpr bool kHasFastChecksum = true;
#endif

/// Stands for a member that the program does not have: empty, zero to whoever reads it, and what it
/// is given is lost.
template <class Value>
struct Absent {
  constexpr Absent() = default;

  // Whoever assigns a value need not know that it is lost. NOLINTNEXTLINE(google-explicit-*)
  constexpr Absent(const Value& /*lost*/) {}

  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr operator Value() const { return {}; }

  constexpr Value operator->() const { return {}; }

  constexpr Absent& operator|=(const Value& /*lost*/) { return *this; }
};

/// A member that only some programs have. Declared [[no_unique_address]] it takes no room in the
/// others, but for the second one of a type at the end of a class.
template <bool kHas, class Value>
using PresentIf = std::conditional_t<kHas, Value, Absent<Value>>;

}  // namespace holdfast::agent
