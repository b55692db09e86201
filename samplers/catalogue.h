// The samplers there are.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "samplers/sampler.h"

namespace halfslope {

class SamplerCatalogue {
 public:
  using Make = std::function<std::unique_ptr<Sampler>()>;

  /// The built-in samplers.
  static SamplerCatalogue built_in();

  /// Adds a sampler under its own info().name; a name that is taken is an assertion failure.
  void add(Make make);
  /// A new instance; Error(kBadInput) naming the nearest sampler where there is none of that name.
  std::unique_ptr<Sampler> make(const std::string& name) const;
  bool has(const std::string& name) const;
  /// In the order they were added.
  std::vector<SamplerInfo> list() const;
  std::vector<std::string> names() const;

 private:
  struct Entry {
    SamplerInfo info;
    Make make;
  };
  std::vector<Entry> entries_;
};

}  // namespace halfslope
