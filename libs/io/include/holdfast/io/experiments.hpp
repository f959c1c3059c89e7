// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/base/lattice.hpp"
#include "holdfast/io/document.hpp"

/// What a lab has built and pulled at, as a file says it; docs/formats.md.
namespace holdfast::io {

/// A structure: a file, by its name, or its own text as JSON.
struct StructureSource {
  std::string file;  ///< Relative to the file that names it; empty if there is a text.
  std::string text;

  friend bool operator==(const StructureSource&, const StructureSource&) = default;
};

/// One experiment, of one of three forms.
struct ExperimentEntry {
  enum class Form {
    kStructure,  ///< A robot with its planned modules: held, or broke.
    kPull,       ///< One connection: held or broke at a force.
    kChain,      ///< Modules that hang below each other from a first connection.
  };

  Form form = Form::kStructure;
  std::string name;  ///< As the file says; may be empty.
  StructureSource structure;
  bool has_held = false;
  /// The connections that broke and were seen to; empty: somewhere, if anything broke.
  std::vector<model::CellPair> where;
  base::ConnectorClass connector = base::ConnectorClass::kVertical;  ///< Of a pull and a chain.
  double force_n = 0;                                                ///< Of a pull.
  int held_count = 0;              ///< Of a chain: so many modules hung, and held.
  std::optional<int> broke_count;  ///< With so many it broke; none: nobody tried.
  double module_weight_n = 0;      ///< Of a chain.
};

struct Experiments {
  std::string name;
  std::vector<ExperimentEntry> entries;
  std::optional<double> strength_cv;  ///< Where it is known.
  verdict::StrengthDistribution distribution = verdict::StrengthDistribution::kLognormal;
  std::vector<StructureSource> next;  ///< Those of which one could be built next.
  std::string family;                 ///< Or those of a family, of these sizes; empty: none.
  std::size_t size_min = 0;
  std::size_t size_max = 0;
};

/// Reads experiments. Errors: what is not as docs/formats.md has it, with its JSON pointer.
base::Result<Experiments> read_experiments(std::string_view text);

}  // namespace holdfast::io
