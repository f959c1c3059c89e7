// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "holdfast/holdfast.hpp"
#include "parts/binary_file.hpp"

namespace holdfast::cluster {
namespace {

constexpr std::string_view kMagic = "HOLDSTEP";
constexpr std::uint32_t kVersion = 1;

template <class Number>
void put(std::string& bytes, Number number) {
  static_assert(std::is_trivially_copyable_v<Number>);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// Takes numbers from the front of bytes that are known to be whole.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  Number take() {
    Number number{};
    std::memcpy(&number, take_bytes(sizeof number).data(), sizeof number);
    return number;
  }

  std::string_view take_bytes(std::size_t count) {
    if (count > bytes_.size()) {
      throw std::out_of_range("a checkpoint whose checksum is right, but not its lengths");
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

 private:
  std::string_view bytes_;
};

/// Whether all are numbers that facets have (solver/contact_iteration.cpp).
bool are_states(std::span<const std::uint8_t> states) {
  return std::ranges::all_of(states, [](std::uint8_t number) {
    return number < 32 && number % 16 < mechanics::ContactState::kCodeCount;
  });
}

}  // namespace

Checkpoint::Checkpoint(PetscRanks& ranks, std::string file, std::uint64_t fingerprint,
                       std::size_t facet_count)
    : ranks_(ranks),
      file_(std::move(file)),
      fingerprint_(fingerprint),
      facet_count_(facet_count),
      facet_begin_(0) {
  const std::vector<std::size_t> starts = host::starts(ranks, facet_count);
  facet_begin_ = starts[base::at(ranks.rank())];
  facet_count_all_ = starts.back();
}

std::optional<base::Error> Checkpoint::read() {
  SharedText text;
  if (ranks_.rank() == 0 && std::filesystem::exists(file_)) {
    std::ifstream in(file_, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    text.document = std::move(bytes).str();
    text.is_error = text.document.empty();  // Ours is never empty.
    text.error = {.code = base::ErrorCode::kUnreadable, .message = "cannot be read"};
  }
  text = shared_by_first(ranks_, text);
  if (text.is_error) {
    return text.error;
  }
  return text.document.empty() ? std::nullopt : take(text.document);
}

std::optional<base::Error> Checkpoint::take(const std::string& bytes) {
  const std::size_t body = bytes.size() < sizeof(std::uint64_t) ? 0 : bytes.size() - 8;
  if (!std::string_view(bytes).starts_with(kMagic)) {
    return base::bad_input(
        "is no checkpoint: expected the letters HOLDSTEP at byte 0, found others");
  }
  if (Reader(std::string_view(bytes).substr(body)).take<std::uint64_t>() !=
      io::text_sum(std::string_view(bytes).substr(0, body))) {
    return base::bad_input("the checkpoint's checksum is wrong: the file was changed or damaged");
  }
  Reader reader(std::string_view(bytes).substr(kMagic.size(), body - kMagic.size()));
  if (const auto version = reader.take<std::uint32_t>(); version != kVersion) {
    return base::bad_input(
        fmt::format("a checkpoint of version {}, known is {}", version, kVersion));
  }
  const auto search_count = reader.take<std::uint32_t>();
  const bool is_same = reader.take<std::uint64_t>() == fingerprint_;
  if (!is_same || reader.take<std::uint64_t>() != facet_count_all_) {
    return base::bad_input("a checkpoint of another structure: remove it, or name another file");
  }
  for (std::uint32_t i = 0; i < search_count; ++i) {
    Search& search = earlier_.emplace_back();
    search.law = reader.take<std::uint64_t>() == 0 ? mechanics::ContactLaw::kRegularised
                                                   : mechanics::ContactLaw::kUnilateral;
    search.gamma = reader.take<double>();
    const std::string_view states = reader.take_bytes(reader.take<std::uint64_t>());
    search.states.assign(states.begin(), states.end());
    const bool is_whole = search.states.empty() || search.states.size() == facet_count_all_;
    if (!is_whole || !are_states(search.states)) {
      return base::bad_input("a checkpoint with states that are not known");
    }
  }
  return std::nullopt;
}

std::string Checkpoint::bytes() const {
  std::string bytes(kMagic);
  put(bytes, kVersion);
  put(bytes, static_cast<std::uint32_t>(searches_.size()));
  put(bytes, fingerprint_);
  put(bytes, std::uint64_t{facet_count_all_});
  for (const Search& search : searches_) {
    put(bytes, std::uint64_t{search.law == mechanics::ContactLaw::kRegularised ? 0U : 1U});
    put(bytes, search.gamma);
    put(bytes, std::uint64_t{search.states.size()});
    bytes.append(search.states.begin(), search.states.end());
  }
  put(bytes, io::text_sum(bytes));
  return bytes;
}

std::vector<std::uint8_t> Checkpoint::begin(mechanics::ContactLaw law, double gamma) {
  Search& search = searches_.emplace_back(Search{.law = law, .gamma = gamma, .states = {}});
  if (earlier_.size() < searches_.size()) {
    return {};
  }
  const Search& before = earlier_[searches_.size() - 1];
  if (before.law != law || before.gamma != gamma || before.states.empty()) {
    earlier_.resize(searches_.size() - 1);  // What followed there is not what follows here.
    return {};
  }
  search.states = before.states;
  const auto mine = search.states.begin() + static_cast<std::ptrdiff_t>(facet_begin_);
  return {mine, mine + static_cast<std::ptrdiff_t>(facet_count_)};
}

void Checkpoint::keep(std::span<const std::uint8_t> states) {
  searches_.back().states = host::gather(static_cast<host::Ranks&>(ranks_), states);
  if (ranks_.rank() == 0) {
    if (const auto error = write_file(file_, bytes())) {
      throw std::runtime_error(fmt::format("the checkpoint {}: {}", file_, error->message));
    }
  }
}

void Checkpoint::remove() const {
  if (ranks_.rank() == 0) {
    std::remove(file_.c_str());
  }
}

}  // namespace holdfast::cluster
