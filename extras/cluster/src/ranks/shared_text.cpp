// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/shared_text.hpp"

#include <array>
#include <cstring>
#include <span>
#include <string_view>

#include "holdfast/base/algebra.hpp"

namespace holdfast::cluster {
namespace {

/// Texts with their lengths before them.
class Letter {
 public:
  Letter() = default;

  explicit Letter(std::string bytes) : bytes_(std::move(bytes)) {}

  void put(std::string_view text) {
    const std::uint64_t size = text.size();
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes_.append(text);
  }

  std::string take() {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes_.data() + place_, sizeof size);
    std::string text = bytes_.substr(place_ + sizeof size, size);
    place_ += sizeof size + size;
    return text;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t place_ = 0;
};

std::string text_of(const base::Cell& cell) {
  return {reinterpret_cast<const char*>(&cell), sizeof cell};
}

}  // namespace

SharedText shared_by_first(PetscRanks& ranks, const SharedText& text) {
  Letter letter;
  if (ranks.rank() == 0) {
    letter.put(text.document);
    letter.put(text_of(text.low));
    letter.put(std::to_string(text.warnings.size()));
    for (const std::string& warning : text.warnings) {
      letter.put(warning);
    }
    letter.put(text.is_error ? "1" : "0");
    letter.put(std::to_string(static_cast<int>(text.error.code)));
    letter.put(text.error.message);
    letter.put(text.error.where);
  }
  const auto all =
      host::gather(static_cast<host::Ranks&>(ranks),
                   std::span<const char>(letter.bytes().data(), letter.bytes().size()));
  Letter received(std::string(all.data(), all.size()));
  SharedText shared;
  shared.document = received.take();
  std::memcpy(static_cast<void*>(&shared.low), received.take().data(), sizeof shared.low);
  const int warning_count = std::stoi(received.take());
  for (int i = 0; i < warning_count; ++i) {
    shared.warnings.push_back(received.take());
  }
  shared.is_error = received.take() == "1";
  shared.error.code = static_cast<base::ErrorCode>(std::stoi(received.take()));
  shared.error.message = received.take();
  shared.error.where = received.take();
  return shared;
}

}  // namespace holdfast::cluster
