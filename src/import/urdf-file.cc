// URDF files, element by element.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf-file.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <map>
#include <sstream>

#include "base/error.h"

namespace tw::urdf {

namespace {

using Element = tinyxml2::XMLElement;

// What other programs put into links, and says nothing here.
constexpr const char* others_of_links[] = {"contact", "gazebo",       "self_collision_checking",
                                           "sensor",  "audio_source", "origin"};
constexpr const char* others_of_robots[] = {"material",     "transmission", "gazebo", "sensor",
                                            "ros2_control", "mujoco",       "plugin", "static"};

template <std::size_t count>
bool is_among(const char* const (&names)[count], const std::string& name) {
  return std::find(names, names + count, name) != names + count;
}

std::string tag(const Element& e) { return "<" + std::string(e.Name()) + ">"; }

class FileReader : LineMending {
 public:
  FileReader(const std::string& file, Mending& mending) : LineMending(file, mending) {}

  Robot read();

 private:
  [[noreturn]] void fail(const Element& e, const std::string& what) const {
    LineMending::fail(e.GetLineNum(), what);
  }

  // ---- values ----

  std::string text_of(const Element& e, const char* attribute) const;
  std::vector<double> numbers(const Element& e, const char* attribute, std::size_t count) const;
  double number(const Element& e, const char* attribute) const {
    return numbers(e, attribute, 1)[0];
  }
  std::optional<double> optional_number(const Element& e, const char* attribute) const {
    if (!e.Attribute(attribute)) return std::nullopt;
    return number(e, attribute);
  }
  double number_or(const Element& e, const char* attribute, double otherwise) const {
    return optional_number(e, attribute).value_or(otherwise);
  }
  Vec3 vector_or(const Element& e, const char* attribute, const Vec3& otherwise) const;
  double positive(const Element& e, const char* attribute) const;
  Pose origin_of(const Element& e) const;

  // ---- elements ----

  Vec3 scale_of(const Element& mesh) const;
  Geometry geometry_of(const Element& piece) const;
  Piece piece_of(const Element& e) const;
  std::optional<Vec3> color_of(const Element& material, bool tell) const;
  void note_colors(const Element& root);
  Inertial inertial_of(const Element& e) const;
  Link link_of(const Element& e) const;
  JointType type_of(const Element& e) const;
  Joint joint_of(const Element& e) const;

  std::map<std::string, Vec3> colors_;  // of the robot's materials
};

std::string FileReader::text_of(const Element& e, const char* attribute) const {
  const char* text = e.Attribute(attribute);
  if (!text) fail(e, tag(e) + " has no " + attribute + "; expected " + attribute + "=\"...\"");
  const std::string found = text;
  if (found.find("${") != std::string::npos || found.find("$(") != std::string::npos)
    fail(e, std::string(attribute) + " of " + tag(e) + " is " + found +
                ", a macro of xacro; expected a URDF, as `xacro FILE > ROBOT.urdf' writes it");
  return found;
}

// In the C locale, whatever the user's.  Commas between numbers, what follows a number without a
// space, and numbers too many are mended.
std::vector<double> FileReader::numbers(const Element& e, const char* attribute,
                                        std::size_t count) const {
  const std::string text = text_of(e, attribute);
  const auto is_space = [](char c) {
    return std::isspace(static_cast<unsigned char>(c)) || c == ',';
  };
  std::vector<double> found;
  bool clean = text.find(',') == std::string::npos, good = true;
  for (const char *p = text.data(), *end = p + text.size(); good;) {
    while (p != end && is_space(*p)) ++p;
    if (p == end) break;
    if (*p == '+') ++p;
    double value = 0;
    const auto [rest, error] = std::from_chars(p, end, value);
    good = error == std::errc() && std::isfinite(value);
    clean = clean && (rest == end || is_space(*rest));
    found.push_back(value);
    p = std::find_if(rest, end, is_space);
  }
  const std::string wrong = std::string(attribute) + " of " + tag(e) + " is \"" + text + "\"";
  const std::string expected = count == 1   ? "a number"
                               : count == 3 ? "three numbers"
                                            : std::to_string(count) + " numbers";
  if (!good || found.size() < count) fail(e, wrong + "; expected " + expected);
  if (clean && found.size() == count) return found;
  found.resize(count);
  std::string taken;
  for (const double x : found) taken += (taken.empty() ? "" : " ") + show(x);
  mending_.mend(at(e.GetLineNum()), wrong, "it is " + taken, expected);
  return found;
}

Vec3 FileReader::vector_or(const Element& e, const char* attribute, const Vec3& otherwise) const {
  if (!e.Attribute(attribute)) return otherwise;
  const std::vector<double> v = numbers(e, attribute, 3);
  return {v[0], v[1], v[2]};
}

double FileReader::positive(const Element& e, const char* attribute) const {
  const double value = number(e, attribute);
  if (!(value > 0))
    fail(e, std::string(attribute) + " of " + tag(e) + " is " + show(value) +
                "; expected a positive number");
  return value;
}

// rpy: turns about x, y and z of the parent, one after the other, rad.
Pose FileReader::origin_of(const Element& e) const {
  const Element* origin = e.FirstChildElement("origin");
  if (!origin) return {};
  const Vec3 rpy = vector_or(*origin, "rpy", Vec3::Zero());
  const auto turn = [](double angle, const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(angle, axis));
  };
  const Quat q =
      turn(rpy.z(), Vec3::UnitZ()) * turn(rpy.y(), Vec3::UnitY()) * turn(rpy.x(), Vec3::UnitX());
  return {vector_or(*origin, "xyz", Vec3::Zero()), q.normalized()};
}

// One number is that of all three.
Vec3 FileReader::scale_of(const Element& mesh) const {
  const char* text = mesh.Attribute("scale");
  if (!text) return Vec3::Ones();
  std::string words = text;
  std::replace(words.begin(), words.end(), ',', ' ');
  std::istringstream in(words);
  const auto count = std::distance(std::istream_iterator<std::string>(in), {});
  if (count == 1) return Vec3::Constant(number(mesh, "scale"));
  return vector_or(mesh, "scale", Vec3::Ones());
}

Geometry FileReader::geometry_of(const Element& piece) const {
  const Element* around = piece.FirstChildElement("geometry");
  const Element* e = around ? around->FirstChildElement() : nullptr;
  if (!e)
    fail(around ? *around : piece,
         tag(piece) +
             " has no geometry; expected <geometry> with <box>, <sphere>, <cylinder>, "
             "<capsule> or <mesh>");
  Geometry made;
  made.line = e->GetLineNum();
  const std::string name = e->Name();
  if (name == "box") {
    made.kind = GeometryKind::box;
    const std::vector<double> size = numbers(*e, "size", 3);
    made.size = {size[0], size[1], size[2]};
    if (!(made.size.minCoeff() > 0))
      fail(*e, "size of <box> is \"" + text_of(*e, "size") + "\"; expected positive numbers");
  } else if (name == "sphere") {
    made.kind = GeometryKind::sphere;
    made.radius = positive(*e, "radius");
  } else if (name == "cylinder" || name == "capsule") {
    made.kind = name == "capsule" ? GeometryKind::capsule : GeometryKind::cylinder;
    made.radius = positive(*e, "radius");
    made.length = positive(*e, "length");
  } else if (name == "plane") {
    made.kind = GeometryKind::plane;
    made.size = vector_or(*e, "normal", Vec3::UnitZ());
    if (!(made.size.norm() > 0)) fail(*e, "normal of <plane> is zero; expected a direction");
  } else if (name == "mesh") {
    made.kind = GeometryKind::mesh;
    made.file = text_of(*e, "filename");
    made.size = scale_of(*e);
    if (!(made.size.cwiseAbs().minCoeff() > 0))
      fail(*e, "scale of <mesh> is \"" + text_of(*e, "scale") + "\"; expected none that is 0");
  } else {
    fail(*e, "the geometry is " + tag(*e) +
                 "; expected <box>, <sphere>, <cylinder>, <capsule> or <mesh>");
  }
  if (const Element* other = e->NextSiblingElement())
    fail(*other, "<geometry> has " + tag(*e) + " and " + tag(*other) + "; expected one");
  return made;
}

Piece FileReader::piece_of(const Element& e) const {
  Piece piece{geometry_of(e), origin_of(e), std::nullopt};
  if (const Element* material = e.FirstChildElement("material"))
    piece.color = color_of(*material, true);
  return piece;
}

// Three numbers or more, clamped; nothing for what is none.
std::optional<Vec3> rgb_of(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Vec3 rgb;
  if (!(in >> rgb[0] >> rgb[1] >> rgb[2]) || !is_finite(rgb)) return std::nullopt;
  return rgb.cwiseMax(0).cwiseMin(1);
}

// `tell`: what cannot be read is told.
std::optional<Vec3> FileReader::color_of(const Element& material, bool tell) const {
  if (const Element* texture = material.FirstChildElement("texture"); texture && tell)
    mending_.mend(at(texture->GetLineNum()), "a <material> has a <texture>", "it is not drawn",
                  "textures of meshes, which are");
  const Element* color = material.FirstChildElement("color");
  if (const char* rgba = color ? color->Attribute("rgba") : nullptr) {
    const std::optional<Vec3> found = rgb_of(rgba);
    if (!found && tell)
      mending_.mend(at(color->GetLineNum()), "rgba of <color> is \"" + std::string(rgba) + "\"",
                    "it is left out", "four numbers from 0 to 1");
    return found;
  }
  const char* name = material.Attribute("name");
  const auto found = colors_.find(name ? name : "");
  if (found == colors_.end()) return std::nullopt;
  return found->second;
}

Inertial FileReader::inertial_of(const Element& e) const {
  Inertial made;
  made.line = made.mass_line = made.inertia_line = e.GetLineNum();
  made.origin = origin_of(e);
  if (const Element* mass = e.FirstChildElement("mass")) {
    made.mass_line = mass->GetLineNum();
    made.mass = number(*mass, "value");
    if (made.mass < 0)
      fail(*mass, "value of <mass> is " + show(made.mass) + "; expected 0 or more, kg");
  }
  if (const Element* inertia = e.FirstChildElement("inertia")) {
    made.inertia_line = inertia->GetLineNum();
    const auto moment = [&](const char* name) { return number_or(*inertia, name, 0); };
    const double xx = moment("ixx"), yy = moment("iyy"), zz = moment("izz");
    const double xy = moment("ixy"), xz = moment("ixz"), yz = moment("iyz");
    made.inertia.emplace() << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  }
  return made;
}

Link FileReader::link_of(const Element& e) const {
  Link link;
  link.name = text_of(e, "name");
  link.line = e.GetLineNum();
  for (const Element* part = e.FirstChildElement(); part; part = part->NextSiblingElement()) {
    const std::string name = part->Name();
    if (name == "inertial") {
      if (link.inertial)
        mending_.mend(at(part->GetLineNum()), "the link " + link.name + " has two <inertial>",
                      "the second is left out", "one");
      else
        link.inertial = inertial_of(*part);
    } else if (name == "collision") {
      link.collisions.push_back(piece_of(*part));
    } else if (name == "visual") {
      try {
        link.visuals.push_back(piece_of(*part));
      } catch (const UserError& error) {
        mending_.mend("", "", error, "the <visual> is left out");
      }
    } else if (name.find(':') == std::string::npos && !is_among(others_of_links, name)) {
      mending_.mend(at(part->GetLineNum()), "the link " + link.name + " has " + tag(*part),
                    "it is left out", "<inertial>, <visual> or <collision>");
    }
  }
  return link;
}

JointType FileReader::type_of(const Element& e) const {
  static const std::pair<const char*, JointType> types[] = {
      {"fixed", JointType::fixed},           {"revolute", JointType::revolute},
      {"continuous", JointType::continuous}, {"prismatic", JointType::prismatic},
      {"planar", JointType::planar},         {"floating", JointType::floating},
      {"spherical", JointType::spherical}};
  const std::string name = text_of(e, "type");
  for (const auto& [known, type] : types)
    if (name == known) return type;
  fail(e, "type of the joint " + text_of(e, "name") + " is " + name +
              "; expected fixed, revolute, continuous, prismatic, planar, floating or spherical");
}

Joint FileReader::joint_of(const Element& e) const {
  Joint joint;
  joint.name = text_of(e, "name");
  joint.line = e.GetLineNum();
  joint.type = type_of(e);
  const auto link = [&](const char* which) {
    const Element* named = e.FirstChildElement(which);
    if (!named)
      fail(e, "the joint " + joint.name + " has no <" + which + ">; expected <" + which +
                  " link=\"...\"/>");
    return text_of(*named, "link");
  };
  joint.parent = link("parent");
  joint.child = link("child");
  joint.origin = origin_of(e);
  if (const Element* axis = e.FirstChildElement("axis"))
    joint.axis = vector_or(*axis, "xyz", Vec3::UnitX());
  if (const Element* dynamics = e.FirstChildElement("dynamics")) {
    joint.damping = number_or(*dynamics, "damping", 0);
    joint.friction = number_or(*dynamics, "friction", 0);
  }
  if (const Element* limit = e.FirstChildElement("limit"))
    joint.limit = Limit{limit->GetLineNum(), optional_number(*limit, "lower"),
                        optional_number(*limit, "upper"), optional_number(*limit, "effort"),
                        optional_number(*limit, "velocity")};
  if (const Element* mimic = e.FirstChildElement("mimic"))
    joint.mimic = Mimic{mimic->GetLineNum(), text_of(*mimic, "joint"),
                        number_or(*mimic, "multiplier", 1), number_or(*mimic, "offset", 0)};
  return joint;
}

// "XML_ERROR_MISMATCHED_ELEMENT" in words.
std::string complaint_of(const tinyxml2::XMLDocument& xml) {
  std::string name = xml.ErrorName();
  if (name.starts_with("XML_ERROR_"))
    name = name.substr(10);
  else if (name.starts_with("XML_"))
    name = name.substr(4);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '_' ? ' ' : static_cast<char>(std::tolower(c));
  });
  return name;
}

// A material may be given once, with its colour, where it is used first.
void FileReader::note_colors(const Element& root) {
  const auto note = [&](const Element* material, bool tell) {
    if (!material || !material->Attribute("name")) return;
    if (const auto color = color_of(*material, tell))
      colors_.emplace(material->Attribute("name"), *color);
  };
  const auto each = [](const Element& of, const char* name, auto&& visit) {
    for (const Element* e = of.FirstChildElement(name); e; e = e->NextSiblingElement(name))
      visit(*e);
  };
  each(root, "material", [&](const Element& material) { note(&material, true); });
  // what is wrong there is told where the visual is read
  each(root, "link", [&](const Element& link) {
    each(link, "visual",
         [&](const Element& visual) { note(visual.FirstChildElement("material"), false); });
  });
}

// Macros are refused wherever they are.
class MacroSearch : public tinyxml2::XMLVisitor {
 public:
  bool VisitEnter(const Element& e, const tinyxml2::XMLAttribute*) override {
    if (!found_ && std::string(e.Name()).starts_with("xacro:")) found_ = &e;
    return !found_;
  }
  const Element* found() const { return found_; }

 private:
  const Element* found_ = nullptr;
};

Robot FileReader::read() {
  std::error_code ignored;
  TW_REQUIRE(std::filesystem::is_regular_file(file_, ignored),
             "the URDF file " + file_ + " is missing; expected a file that can be read");
  std::ifstream in(file_, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  const std::string all = text.str();
  tinyxml2::XMLDocument xml;
  if (xml.Parse(all.data(), all.size()) != tinyxml2::XML_SUCCESS)
    throw UserError(at(std::max(1, xml.ErrorLineNum())) + complaint_of(xml) +
                    "; expected well-formed XML");
  const Element* root = xml.RootElement();
  if (!root || std::string(root->Name()) != "robot")
    throw UserError(at(root ? root->GetLineNum() : 1) + "the file is " +
                    (root ? tag(*root) : "empty") + "; expected a URDF, whose root is <robot>");
  MacroSearch macros;
  root->Accept(&macros);
  if (const Element* macro = macros.found())
    fail(*macro, tag(*macro) +
                     " is a macro of xacro; expected a URDF, as `xacro FILE > ROBOT.urdf' "
                     "writes it");
  Robot robot;
  robot.name = root->Attribute("name") ? text_of(*root, "name") : "";
  note_colors(*root);
  for (const Element* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string name = e->Name();
    if (name == "link")
      robot.links.push_back(link_of(*e));
    else if (name == "joint")
      robot.joints.push_back(joint_of(*e));
    else if (name.find(':') == std::string::npos && !is_among(others_of_robots, name))
      mending_.mend(at(e->GetLineNum()), "<robot> has " + tag(*e), "it is left out",
                    "<link>, <joint> or <material>");
  }
  if (robot.links.empty()) fail(*root, "<robot> has no link; expected one <link> or more");
  return robot;
}

}  // namespace

Robot read_file(const std::string& file, Mending& mending) {
  return FileReader(file, mending).read();
}

}  // namespace tw::urdf
