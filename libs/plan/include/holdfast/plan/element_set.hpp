// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// The elements of a structure that are there: the state of one that grows or is taken apart.
namespace holdfast::plan {

/// The index of an element: of a module in the target, of a bar in a frame.
using Element = std::int32_t;

/// A set of elements 0 to N - 1, with a hash that follows every change in constant time. The hash
/// only finds candidates for equality, which is exact, so no result depends on it.
class ElementSet {
 public:
  ElementSet() = default;

  explicit ElementSet(std::size_t element_count) : words_((element_count + 63) / 64) {}

  /// How many elements are in the set.
  std::size_t size() const { return size_; }

  bool contains(Element element) const {
    return (words_[word_of(element)] >> bit_of(element) & 1U) != 0;
  }

  /// The element must not be there.
  void insert(Element element) { change(element, 1); }

  /// The element must be there.
  void erase(Element element) { change(element, -1); }

  /// All elements, ascending.
  std::vector<Element> elements() const {
    std::vector<Element> list;
    list.reserve(size_);
    for (std::size_t word = 0; word < words_.size(); ++word) {
      for (std::uint64_t bits = words_[word]; bits != 0; bits &= bits - 1) {
        list.push_back(static_cast<Element>(64 * word) + __builtin_ctzll(bits));
      }
    }
    return list;
  }

  std::uint64_t hash() const { return hash_; }

  /// 64 elements in each, ascending from the lowest bit.
  const std::vector<std::uint64_t>& words() const { return words_; }

  friend bool operator==(const ElementSet&, const ElementSet&) = default;

 private:
  static std::size_t word_of(Element element) { return static_cast<std::size_t>(element) / 64; }

  static unsigned bit_of(Element element) { return static_cast<unsigned>(element) % 64U; }

  /// A number of its own for every element, by the mixing of base::Rng.
  static std::uint64_t key_of(Element element) {
    std::uint64_t mixed = (static_cast<std::uint64_t>(element) + 1) * 0x9e3779b97f4a7c15U;
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    return mixed ^ (mixed >> 31U);
  }

  void change(Element element, int by) {
    words_[word_of(element)] ^= std::uint64_t{1} << bit_of(element);
    hash_ ^= key_of(element);
    size_ = by > 0 ? size_ + 1 : size_ - 1;
  }

  std::uint64_t hash_ = 0;
  std::size_t size_ = 0;
  std::vector<std::uint64_t> words_;
};

/// A hash for containers that are asked and never walked through.
struct ElementSetHash {
  std::size_t operator()(const ElementSet& set) const {
    return static_cast<std::size_t>(set.hash());
  }
};

}  // namespace holdfast::plan
