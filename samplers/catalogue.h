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
  using MakeOne =
      std::function<std::unique_ptr<Sampler>(const std::string& argument, const SamplerCatalogue& catalogue)>;

  /// The built-in samplers.
  static SamplerCatalogue built_in();

  /// Adds a sampler under its own info().name; a name that is taken is an assertion failure.
  void add(Make make);
  /// Adds samplers that are named PREFIX:ARGUMENT. `info`, whose name is such as "file:PATH", is what list() says of
  /// them; `make` gets the argument and this catalogue, and throws Error(kBadInput) for an argument that is none.
  void add_family(SamplerInfo info, MakeOne make);
  /// A new instance; Error(kBadInput) naming the nearest sampler where there is none of that name.
  std::unique_ptr<Sampler> make(const std::string& name) const;
  bool has(const std::string& name) const;
  /// In the order they were added; of a family, its one entry.
  std::vector<SamplerInfo> list() const;
  std::vector<std::string> names() const;

 private:
  struct Entry {
    SamplerInfo info;
    MakeOne make;
    bool family;
  };
  const Entry* find(const std::string& name) const;
  std::vector<Entry> entries_;
};

}  // namespace halfslope
