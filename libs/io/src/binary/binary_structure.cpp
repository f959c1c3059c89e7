// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/binary_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/solver/morton_key.hpp"

namespace holdfast::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

constexpr std::uint64_t kTextSizeMax = std::uint64_t{1} << 30U;

/// The number of modules beyond which the file is not what it seems.
constexpr std::uint64_t kModuleCountMax = std::uint64_t{1} << 40U;

std::uint64_t sum_of(const BinaryHead& head) {
  return text_sum({reinterpret_cast<const char*>(&head), offsetof(BinaryHead, head_sum)});
}

/// Mixes a word as splitmix64 does.
std::uint64_t mixed(std::uint64_t word) {
  word = (word ^ word >> 30U) * 0xbf58476d1ce4e5b9U;
  word = (word ^ word >> 27U) * 0x94d049bb133111ebU;
  return word ^ word >> 31U;
}

/// The largest coordinate of a robot's lowest corner: bricks of sheared lattices reach further than
/// their cells.
constexpr std::int32_t kLowMax = 4 * base::kCoordinateMax;

bool is_within(const base::Cell& cell, std::int32_t most) {
  const auto is_near = [most](std::int32_t value) { return value >= -most && value <= most; };
  return is_near(cell.x) && is_near(cell.y) && is_near(cell.z);
}

/// Says what is wrong with a record wherever it stands; null if nothing is.
const char* find_own_fault(const ModuleRecord& record, const solver::Bricks& bricks,
                           const base::Cell& low) {
  if (!is_within(record.place(), base::kCoordinateMax)) {
    return "it lies outside the lattice, expected coordinates from -1000000 to 1000000";
  }
  const base::Cell brick = bricks.of(record.place());
  if (brick.x < low.x || brick.y < low.y || brick.z < low.z) {
    return "it lies below the low corner";
  }
  return record.flags > ModuleRecord::kFixed ? "flags that are not known" : nullptr;
}

std::optional<base::Error> find_fault(const BinaryHead& head, std::uint64_t file_size) {
  if (head.magic != BinaryHead().magic) {
    return base::bad_input("is no binary structure: expected the letters HOLDFAST, found others",
                           "byte 0");
  }
  if (head.version != BinaryHead::kVersion) {
    return base::bad_input(
        fmt::format("version {}, known is {}", head.version, BinaryHead::kVersion), "byte 8");
  }
  if (head.head_sum != sum_of(head)) {
    return base::bad_input("the head's checksum is wrong: the file was changed or damaged",
                           "byte 64");
  }
  if (head.record_size != sizeof(ModuleRecord) || head.text_size > kTextSizeMax ||
      head.module_count == 0 || head.module_count > kModuleCountMax) {
    return base::bad_input(
        fmt::format("{} of {} and a text of {}", host::counted(head.module_count, "module"),
                    host::counted(head.record_size, "byte"), host::counted(head.text_size, "byte")),
        "byte 12");
  }
  if (!is_within(head.low_corner(), kLowMax) || head.zero != 0) {
    return base::bad_input(
        "the lowest corner is not that of a robot's modules, or is not followed by 0", "byte 32");
  }
  const std::uint64_t expected = head.records_begin() + sizeof(ModuleRecord) * head.module_count;
  if (file_size != expected) {
    return base::bad_input(
        fmt::format("expected {}, found {}", host::counted(expected, "byte"), file_size),
        fmt::format("byte {}", std::min(file_size, expected)));
  }
  return std::nullopt;
}

/// Modules that have something of their own, by their place in the document.
std::set<std::pair<std::size_t, std::size_t>> special_modules(const Document& document) {
  std::set<std::pair<std::size_t, std::size_t>> special;
  for (const OwnParameters& own : document.extension.own) {
    special.emplace(own.step, own.module);
  }
  return special;
}

/// Takes away what an extension says of pairs and bodies of which later steps bring a module.
void forget_later(const Document& document, Extension& extension) {
  if (document.steps.size() <= 1 && document.extension.plan.empty()) {
    return;
  }
  std::set<base::Cell> there;
  for (const ModuleEntry& module : document.modules) {
    there.insert(module.cell);
  }
  if (!document.steps.empty()) {
    for (const PlannedEntry& planned : document.steps.front()) {
      there.insert(planned.cell);
    }
  }
  const auto is_later = [&](const base::Cell& cell) { return !there.contains(cell); };
  const auto has_later = [&](const auto& cells) { return std::ranges::any_of(cells, is_later); };
  std::erase_if(extension.open, has_later);
  std::erase_if(extension.bodies, has_later);
  std::erase_if(extension.connections,
                [&](const ConnectionEntry& entry) { return has_later(entry.between); });
}

/// The document without its modules but those that have something of their own, and the first.
Document without_modules(const Document& document) {
  Document common;
  common.name = document.name;
  common.support_z = document.support_z;
  common.material = document.material;
  common.is_default_modulus_stated = document.is_default_modulus_stated;
  common.extension = document.extension;
  common.extension.own.clear();
  common.extension.plan.clear();
  if (!common.extension.payloads.empty() && step_count(document) > 0) {
    if (const auto spec = make_spec(document)) {
      common.extension.payloads = spec.value().payloads;  // None on modules that come later.
    }
  }
  forget_later(document, common.extension);
  const auto special = special_modules(document);
  for (std::size_t i = 0; i < document.modules.size(); ++i) {
    if (i == 0 || special.contains({0, i})) {
      common.modules.emplace_back().cell = document.modules[i].cell;
    }
  }
  for (const OwnParameters& own : document.extension.own) {
    const bool is_planned = own.step == 1;
    if (own.step > 1) {
      continue;
    }
    const base::Cell& cell =
        is_planned ? document.steps.front()[own.module].cell : document.modules[own.module].cell;
    auto found = std::ranges::find(common.modules, cell, &ModuleEntry::cell);
    if (found == common.modules.end()) {
      common.modules.emplace_back().cell = cell;
      found = common.modules.end() - 1;
    }
    OwnParameters moved = own;
    moved.step = 0;
    moved.module = static_cast<std::size_t>(found - common.modules.begin());
    common.extension.own.push_back(std::move(moved));
  }
  std::ranges::sort(common.extension.own, {}, &OwnParameters::module);
  return common;
}

std::vector<ModuleRecord> records_of(const Document& document) {
  std::vector<ModuleRecord> records;
  records.reserve(document.modules.size());
  for (const ModuleEntry& module : document.modules) {
    const auto& [x, y, z] = module.cell;
    records.push_back({.cell = {x, y, z}, .flags = module.is_fixed ? ModuleRecord::kFixed : 0});
  }
  if (!document.steps.empty()) {
    for (const PlannedEntry& planned : document.steps.front()) {
      const auto& [x, y, z] = planned.cell;
      records.push_back({.cell = {x, y, z}, .flags = ModuleRecord::kPlanned});
    }
  }
  return records;
}

base::Cell low_corner(const base::Lattice& lattice, const std::vector<ModuleRecord>& records) {
  const solver::Bricks bricks(lattice);
  base::Cell low = bricks.of(records.front().place());
  for (const ModuleRecord& record : records) {
    const base::Cell brick = bricks.of(record.place());
    low = {std::min(low.x, brick.x), std::min(low.y, brick.y), std::min(low.z, brick.z)};
  }
  return low;
}

/// Sorts modules along the curve. Error: two in one cell.
std::optional<base::Error> sort_along_curve(const base::Lattice& lattice, const base::Cell& low,
                                            std::vector<ModuleRecord>& records) {
  const solver::Bricks bricks(lattice);
  std::vector<std::pair<std::uint64_t, ModuleRecord>> keyed;
  keyed.reserve(records.size());
  for (const ModuleRecord& record : records) {
    keyed.emplace_back(solver::morton_key(bricks.of(record.place()), low), record);
  }
  const auto key = [](const auto& one) { return one.first; };
  std::ranges::sort(keyed, {}, key);
  const auto twice = std::ranges::adjacent_find(keyed, {}, key);
  if (twice != keyed.end()) {
    return base::bad_input(
        fmt::format("the cell {} is listed twice", model::text(twice->second.place())));
  }
  std::ranges::transform(keyed, records.begin(), [](const auto& one) { return one.second; });
  return std::nullopt;
}

/// A module that the text names, and what it has of its own there, if anything.
struct NamedModule {
  base::Cell cell;
  OwnParameters* own = nullptr;
};

/// The modules of a document, by their cells. What they have of their own points into it.
std::vector<NamedModule> named_modules(const std::vector<ModuleEntry>& modules,
                                       std::vector<OwnParameters>& own) {
  std::vector<NamedModule> named;
  named.reserve(modules.size());
  for (const ModuleEntry& module : modules) {
    named.push_back({.cell = module.cell});
  }
  for (OwnParameters& one : own) {
    named[one.module].own = &one;
  }
  std::ranges::sort(named, {}, &NamedModule::cell);
  return named;
}

/// Puts records into a document that names those modules only that have something of their own, and
/// the first one; it plans none.
std::optional<base::Error> take_modules(std::span<const ModuleRecord> records, Document& document) {
  const std::vector<NamedModule> named =
      named_modules(std::exchange(document.modules, {}), document.extension.own);
  std::size_t found = 0;
  const auto planned_count = static_cast<std::size_t>(
      std::ranges::count(records, ModuleRecord::kPlanned, &ModuleRecord::flags));
  document.modules.reserve(records.size() - planned_count);
  Step planned;
  for (const ModuleRecord& record : records) {
    const base::Cell cell = record.place();
    const bool is_planned = record.flags == ModuleRecord::kPlanned;
    const auto at = std::ranges::lower_bound(named, cell, {}, &NamedModule::cell);
    if (at != named.end() && at->cell == cell) {
      ++found;
      if (at->own != nullptr) {
        at->own->step = is_planned ? 1 : 0;
        at->own->module = is_planned ? planned.size() : document.modules.size();
      }
    }
    if (is_planned) {
      planned.emplace_back().cell = cell;
    } else {
      ModuleEntry& module = document.modules.emplace_back();
      module.cell = cell;
      module.is_fixed = record.flags == ModuleRecord::kFixed;
    }
  }
  if (found != named.size()) {
    return base::bad_input("the text names a module twice, or one that is not there",
                           fmt::format("byte {}", sizeof(BinaryHead)));
  }
  std::ranges::sort(document.extension.own, {},
                    [](const OwnParameters& one) { return std::pair(one.step, one.module); });
  if (!planned.empty()) {
    document.steps = {std::move(planned)};
  }
  return std::nullopt;
}

}  // namespace

std::uint64_t text_sum(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char letter : text) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3U;
  }
  return hash;
}

std::uint64_t record_sum(std::span<const ModuleRecord> records, std::uint64_t first) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    std::array<std::uint64_t, 2> words{};
    std::memcpy(words.data(), &records[i], sizeof words);
    sum += mixed(mixed(mixed(first + i + 1) ^ words[0]) ^ words[1]);
  }
  return sum;
}

base::Result<BinaryHead> read_binary_head(std::string_view begin, std::uint64_t file_size) {
  BinaryHead head;
  if (begin.size() < sizeof head) {
    return base::bad_input(fmt::format("{} long, the head alone has {}",
                                       host::counted(file_size, "byte"), sizeof head),
                           fmt::format("byte {}", file_size));
  }
  std::memcpy(&head, begin.data(), sizeof head);
  if (auto fault = find_fault(head, file_size)) {
    return *std::move(fault);
  }
  return head;
}

base::Result<ReadDocument> read_binary_text(const BinaryHead& head, std::string_view text,
                                            const ReadOptions& options) {
  if (text_sum(text) != head.text_sum) {
    return base::bad_input("the text's checksum is wrong: the file was changed or damaged",
                           "byte 48");
  }
  auto read = read_json(text, options);
  if (read && step_count(read.value().document) > 0) {
    return base::bad_input("the text has steps; planned modules stand behind it, among all modules",
                           fmt::format("byte {}", sizeof head));
  }
  return read;
}

std::string find_record_fault(std::span<const ModuleRecord> records, std::uint64_t first,
                              const base::Lattice& lattice, const base::Cell& low,
                              std::int64_t before) {
  const solver::Bricks bricks(lattice);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const ModuleRecord& record = records[i];
    if (const char* fault = find_own_fault(record, bricks, low)) {
      return fmt::format("the module {} in the cell {}: {}", first + i, model::text(record.place()),
                         fault);
    }
    const base::Cell brick = bricks.of(record.place());
    const std::uint64_t key = solver::morton_key(brick, low);
    if (static_cast<std::int64_t>(key) <= before) {
      return fmt::format(
          "the module {} in the cell {}: it is there twice, or not in its place along the curve",
          first + i, model::text(record.place()));
    }
    before = static_cast<std::int64_t>(key);
  }
  return {};
}

std::optional<base::Error> find_sum_fault(const BinaryHead& head, std::uint64_t record_sum) {
  if (record_sum != head.record_sum) {
    return base::bad_input("the modules' checksum is wrong: the file was changed or damaged",
                           "byte 56");
  }
  return std::nullopt;
}

std::string common_text(const Document& document) { return write_json(without_modules(document)); }

base::Result<BinaryStructure> make_binary(const Document& document) {
  if (auto spec = make_spec(document); !spec) {
    return spec.error();
  }
  BinaryStructure structure{
      .low = {}, .text = common_text(document), .records = records_of(document)};
  if (structure.records.empty()) {
    return base::bad_input("expected at least one module, found none");
  }
  structure.low = low_corner(document.extension.lattice, structure.records);
  if (auto error = sort_along_curve(document.extension.lattice, structure.low, structure.records)) {
    return *std::move(error);
  }
  return structure;
}

std::string binary_beginning(const base::Cell& low, const std::string& text,
                             std::uint64_t module_count, std::uint64_t record_sum) {
  BinaryHead head{.module_count = module_count,
                  .text_size = text.size(),
                  .low = {low.x, low.y, low.z},
                  .text_sum = text_sum(text),
                  .record_sum = record_sum};
  head.head_sum = sum_of(head);
  std::string bytes(reinterpret_cast<const char*>(&head), sizeof head);
  bytes += text;
  bytes.resize(head.records_begin(), '\0');
  return bytes;
}

void write_binary(std::ostream& out, const BinaryStructure& structure) {
  const std::span<const ModuleRecord> records = structure.records;
  out << binary_beginning(structure.low, structure.text, records.size(), record_sum(records, 0));
  out.write(reinterpret_cast<const char*>(records.data()),
            static_cast<std::streamsize>(records.size_bytes()));
}

std::vector<std::string> lost_in_binary(const Document& document) {
  const auto is_painted = [](const auto& entry) {
    return entry.color.has_value() || !entry.attributes.empty();
  };
  const bool is_step_painted = std::ranges::any_of(
      document.steps, [&](const Step& step) { return std::ranges::any_of(step, is_painted); });
  std::vector<std::string> lost;
  const auto note = [&](bool is_lost, const char* what) {
    if (is_lost) {
      lost.emplace_back(fmt::format("{}: a binary structure has no room for it", what));
    }
  };
  note(document.steps.size() > 1 || !document.extension.plan.empty(),
       "what is planned after the first step is left out");
  note(is_step_painted || std::ranges::any_of(document.modules, is_painted),
       "colours and attributes of modules are left out");
  note(!document.scenery.empty() || !document.targets.empty() || !document.parameters.empty() ||
           !document.world.empty() || !document.block_list.empty(),
       "what is VisibleSim's own is left out");
  note(!document.description.empty() || document.known_answer.has_value(),
       "the description and the known answer are left out");
  return lost;
}

base::Result<ReadDocument> read_binary(std::string_view bytes, const ReadOptions& options) {
  const auto read_head = read_binary_head(bytes, bytes.size());
  if (!read_head) {
    return read_head.error();
  }
  const BinaryHead& head = read_head.value();
  if (head.module_count > model::kModuleCountMax) {
    return base::bad_input(
        fmt::format("{} modules, expected at most {}", head.module_count, model::kModuleCountMax),
        "byte 16");
  }
  auto read = read_binary_text(head, bytes.substr(sizeof head, head.text_size), options);
  if (!read) {
    return read;
  }
  ReadDocument result = std::move(read).value();
  std::vector<ModuleRecord> records(head.module_count);
  std::memcpy(records.data(), bytes.substr(head.records_begin()).data(),
              records.size() * sizeof(ModuleRecord));
  const std::string fault =
      find_record_fault(records, 0, result.document.extension.lattice, head.low_corner(), -1);
  if (!fault.empty()) {
    return base::bad_input(fault);
  }
  if (auto sum_fault = find_sum_fault(head, record_sum(records, 0))) {
    return *std::move(sum_fault);
  }
  if (auto missing = take_modules(records, result.document)) {
    return *std::move(missing);
  }
  return result;
}

}  // namespace holdfast::io
