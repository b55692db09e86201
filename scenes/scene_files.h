// The files that make a scene, as one tree of elements.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenes/substitution.h"
#include "scenes/xml_file.h"

namespace halfslope {

/// A scene file with what it includes: names brought to Mitsuba 3, parameters put in, ids known. Elements that come
/// from it live as long as it does.
class SceneFiles {
 public:
  /// `text` is the file's content and `file` its name for messages, and where relative names start from. Throws
  /// Error(kBadInput) with file:line for a version that is not 0.x to 3.x, an include that is missing, cyclic, more
  /// than 15 deep or one of more than 1000, an unknown $name, an id that stands twice, and what XmlFile refuses.
  SceneFiles(std::string text, const std::string& file, const SceneParameters& parameters);
  SceneFiles(const SceneFiles&) = delete;
  SceneFiles& operator=(const SceneFiles&) = delete;

  Element root() const { return {*file_, file_->root()}; }
  const std::string& version() const { return version_; }  ///< as the file says
  bool upgraded() const { return file_->upgraded; }
  const std::vector<std::string>& included() const { return included_; }  ///< files, in order

  /// The file that `name` says: absolute, or relative to the file that `element` stands in, to a <path> of the scene
  /// or to the scene file. Throws Error(kBadInput) at the element if there is none or it is no regular file.
  std::filesystem::path find(const Element& element, const std::string& name) const;

 private:
  /// The files that are open: each but the first is included by the one before.
  using Open = std::vector<std::filesystem::path>;

  void prepare(XmlFile& file, Open& open);
  void visit(XmlFile& file, const Element& element, Open& open);
  void include(XmlFile& file, const Element& element, Open& open);
  void add_folder(const Element& element);
  void collect_ids(const Element& element);

  XmlBudget budget_;
  Substitution substitution_;
  std::string version_;
  std::vector<std::filesystem::path> folders_;
  std::vector<std::string> included_;
  Ids ids_;
  std::unique_ptr<XmlFile> file_;
};

}  // namespace halfslope
