// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/module/configurer.hpp"
#include "holdfast/module/instrument.hpp"
#include "holdfast/module/module.hpp"

namespace holdfast::module {

/// All that runs on a module with room for it: the program, an instrument's counterpart, and what
/// takes a configuration by message. Without a valid configuration it waits for one, and its lamp
/// blinks in cyan.
class Program {
 public:
  /// Keeps references. The configuration may be invalid, and becomes what the module is told. An
  /// `id` other than 0, from the chip's unique number, replaces the configuration's.
  Program(Configuration& configuration, std::uint32_t id, PlanMemory& plans, Port& port);

  /// Does what there is to do, then waits for more.
  void run_once();

  void plan(const base::Cell& cell);
  void withdraw(const base::Cell& cell);

  void tell_who(const Who& who) { configurer_.tell_who(who); }

  const Status& status() const { return module_ ? module_->status() : kNone; }

 private:
  static constexpr Status kNone{};

  void begin();
  void wait_for_configuration();

  Configuration& configuration_;
  PlanMemory& plans_;
  Configurer configurer_;
  Instrument instrument_;
  std::optional<Module> module_;
};

/// An id for a module from the unique number of its chip, never 0 (FNV-1a, 32 bits). Of a thousand
/// modules two have the same with a probability of 1e-4; neighbours of it then are `undecided`.
std::uint32_t id_of(std::span<const std::uint8_t> unique_number);

}  // namespace holdfast::module
