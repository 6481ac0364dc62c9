// Robots from URDF files.
//
// urdfdom reads them; what it does not keep, the lines, is looked up in the XML again.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf.h"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "import/mesh-file.h"

namespace tw {

using namespace multibody;
namespace fs = std::filesystem;

namespace {

// What urdfdom says instead of raising it: the first complaint.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() { console_bridge::useOutputHandler(this); }
  ~Complaints() override { console_bridge::restorePreviousOutputHandler(); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

Vec3 from(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }
Pose from(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {from(pose.position), Quat(r.w, r.x, r.y, r.z).normalized()};
}

Pose inverse(const Pose& pose) {
  const Quat q = pose.q.conjugate();
  return {-(q * pose.p), q};
}

class Reader {
 public:
  Reader(const std::string& file, bool free) : file_(file), free_(free) {
    std::error_code ignored;
    TW_REQUIRE(fs::is_regular_file(file, ignored),
               "the URDF file " + file + " is missing; expected a file that can be read");
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    xml_.Parse(text.str().c_str(), nullptr, TIXML_ENCODING_UTF8);
    if (xml_.Error())
      throw UserError(at(xml_.ErrorRow()) + xml_.ErrorDesc() + "; expected well-formed XML");
    Complaints complaints;
    model_ = urdf::parseURDF(text.str());
    if (!model_ || !model_->getRoot())
      throw UserError(file + ": " +
                      (complaints.first().empty() ? "it has no robot" : complaints.first()) +
                      "; expected a URDF with one <robot>");
  }

  UrdfRobot read() {
    robot_.name = model_->getName();
    add(*model_->getRoot(), "", Pose{});
    for (const auto& [name, link] : model_->links_)
      if (!added_.contains(name))
        throw UserError(at(line_of("link", name)) + "the link " + name +
                        " does not hang on the root, " + model_->getRoot()->name +
                        "; expected a tree of joints, without cycles");
    if (robot_.links.empty())
      throw UserError(file_ + ": the robot " + model_->getName() +
                      " has no link with a mass; expected one or more with <inertial>");
    for (std::size_t i = 0; i < shapes_.size(); ++i) finish(i);
    return std::move(robot_);
  }

 private:
  // What a link is made of so far: its own shapes and those of parts without mass.
  struct Shapes {
    std::vector<ShapePtr> touching, seen;
    std::optional<Vec3> color;
  };

  // ---- errors ----

  std::string at(int line) const { return file_ + ":" + std::to_string(line) + ": "; }
  // <tag name="name"> of the robot; null: there is none.
  const TiXmlElement* element(const char* tag, const std::string& name) const {
    const TiXmlElement* robot = xml_.FirstChildElement("robot");
    const TiXmlElement* e = robot ? robot->FirstChildElement(tag) : nullptr;
    for (; e; e = e->NextSiblingElement(tag))
      if (const char* its = e->Attribute("name"); its && name == its) break;
    return e;
  }
  // Its line, or that of its first descendant `part` where there is one.
  int line_of(const char* tag, const std::string& name, const char* part = nullptr) const {
    const TiXmlElement* found = element(tag, name);
    if (!found) return 1;
    const TiXmlElement* inner = part ? descendant(*found, part) : nullptr;
    return (inner ? inner : found)->Row();
  }
  static const TiXmlElement* descendant(const TiXmlElement& of, const char* tag) {
    for (const TiXmlElement* e = of.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (e->ValueStr() == tag) return e;
      if (const TiXmlElement* found = descendant(*e, tag)) return found;
    }
    return nullptr;
  }
  // The line of the <mesh> of a link that names this file.
  int line_of_mesh(const std::string& link, const std::string& file) const {
    const TiXmlElement* found = element("link", link);
    for (const TiXmlElement* part = found ? found->FirstChildElement() : nullptr; part;
         part = part->NextSiblingElement())
      if (const TiXmlElement* mesh = descendant(*part, "mesh"))
        if (const char* name = mesh->Attribute("filename"); name && file == name)
          return mesh->Row();
    return line_of("link", link, "mesh");
  }

  // ---- shapes ----

  // package://NAME/REST lies in a folder NAME above the file, or on ROS_PACKAGE_PATH; other names
  // are taken from the file's folder.
  std::string find_mesh(const std::string& name) const {
    const fs::path folder = fs::absolute(file_).parent_path();
    if (name.starts_with("file://")) return name.substr(7);
    if (!name.starts_with("package://")) return (folder / name).lexically_normal().string();
    const fs::path inside = name.substr(10);
    std::error_code ignored;
    for (fs::path above = folder;; above = above.parent_path()) {
      if (fs::exists(above / inside, ignored)) return (above / inside).string();
      if (above == above.parent_path()) break;
    }
    if (const char* paths = std::getenv("ROS_PACKAGE_PATH")) {
      std::istringstream all(paths);
      for (std::string path; std::getline(all, path, ':');) {
        const fs::path inner = inside.lexically_relative(*inside.begin());
        for (const fs::path& found : {fs::path(path) / inside, fs::path(path) / inner})
          if (fs::exists(found, ignored)) return found.string();
      }
    }
    return name;
  }

  ShapePtr shape_of(const urdf::Geometry& geometry) const {
    switch (geometry.type) {
      case urdf::Geometry::SPHERE:
        return make_sphere(static_cast<const urdf::Sphere&>(geometry).radius);
      case urdf::Geometry::BOX: return make_box(from(static_cast<const urdf::Box&>(geometry).dim));
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        return make_cylinder(cylinder.radius, cylinder.length);
      }
      case urdf::Geometry::MESH: break;
    }
    const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
    std::vector<Vec3> points = mesh_points(find_mesh(mesh.filename));
    for (Vec3& p : points) p = p.cwiseProduct(from(mesh.scale));
    return make_hull(points);
  }

  ShapePtr placed_shape(const urdf::GeometrySharedPtr& geometry, const urdf::Pose& origin,
                        const Pose& part, const std::string& link) const {
    if (!geometry) return nullptr;
    try {
      return place_shape(shape_of(*geometry), part * from(origin));
    } catch (const UserError& error) {
      const bool mesh = geometry->type == urdf::Geometry::MESH;
      const int line = mesh ? line_of_mesh(link, static_cast<const urdf::Mesh&>(*geometry).filename)
                            : line_of("link", link);
      throw UserError(at(line) + (mesh ? "<mesh>" : "a shape") + " of the link " + link + ": " +
                      error.what());
    }
  }

  // Shapes of a link that lies at `part` in what it belongs to.
  void add_shapes(const urdf::Link& link, const Pose& part, Shapes& shapes) {
    for (const auto& collision : link.collision_array)
      if (auto shape = placed_shape(collision->geometry, collision->origin, part, link.name))
        shapes.touching.push_back(std::move(shape));
    for (const auto& visual : link.visual_array) {
      if (visual->material && !shapes.color) {
        const urdf::Color& c = visual->material->color;
        shapes.color = Vec3(c.r, c.g, c.b);
      }
      // drawn as it touches where it does
      if (!link.collision_array.empty()) continue;
      if (auto shape = placed_shape(visual->geometry, visual->origin, part, link.name))
        shapes.seen.push_back(std::move(shape));
    }
  }

  static ShapePtr together(const std::vector<ShapePtr>& shapes) {
    if (shapes.empty()) return nullptr;
    return shapes.size() == 1 ? shapes.front() : make_union(shapes);
  }

  void finish(std::size_t number) {
    const Shapes& shapes = shapes_[number];
    LinkDef& link = robot_.links[number];
    link.body.color = shapes.color;
    link.body.shape = together(shapes.touching);
    if (link.body.shape || shapes.seen.empty()) return;
    link.body.shape = together(shapes.seen);
    robot_.untouchable.push_back(link.name);
  }

  // ---- links and joints ----

  static bool has_mass(const urdf::Link& link) { return link.inertial && link.inertial->mass > 0; }

  JointSpec joint_of(const urdf::Joint& joint, const Pose& part) const {
    const auto refuse = [&](const char* what, const char* expected) {
      throw UserError(at(line_of("joint", joint.name)) + "the joint " + joint.name + " is " + what +
                      "; expected " + expected);
    };
    constexpr const char* kinds = "fixed, revolute, continuous or prismatic";
    JointSpec spec;
    switch (joint.type) {
      case urdf::Joint::FIXED: spec.kind = JointKind::weld; break;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS: spec.kind = JointKind::revolute; break;
      case urdf::Joint::PRISMATIC: spec.kind = JointKind::prismatic; break;
      case urdf::Joint::FLOATING: refuse("floating", kinds); break;
      case urdf::Joint::PLANAR: refuse("planar", kinds); break;
      default: refuse("of an unknown type", kinds);
    }
    if (joint.mimic) refuse("driven by another one, <mimic>", "a joint that moves by itself");
    spec.placement = part * from(joint.parent_to_joint_origin_transform);
    spec.axis = from(joint.axis);
    if (spec.kind != JointKind::weld && !(spec.axis.norm() > 0)) refuse("about no axis", "an axis");
    AxisSpec& axis = spec.axes[0];
    if (joint.dynamics) {
      axis.damping = joint.dynamics->damping;
      axis.friction = joint.dynamics->friction;
    }
    const bool ends = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::PRISMATIC;
    if (ends && joint.limits) {
      axis.lower = joint.limits->lower;
      axis.upper = joint.limits->upper;
      if (!(axis.lower <= axis.upper))
        throw UserError(at(line_of("joint", joint.name, "limit")) + "the limits of the joint " +
                        joint.name + " are " + show(axis.lower) + " and " + show(axis.upper) +
                        "; expected a lower and an upper one");
    }
    return spec;
  }

  // The link and what hangs on it.  `owner`: the link with a mass that its parent is, or is a part
  // of, which has the parent's frame at `part`; empty: the base.
  void add(const urdf::Link& link, const std::string& owner, const Pose& part) {
    const bool root = !link.parent_joint;
    if (!added_.insert(link.name).second)
      throw UserError(at(line_of("link", link.name)) + "the link " + link.name +
                      " is the child of two joints; expected one");
    if (link.inertial && !(link.inertial->mass >= 0))
      throw UserError(at(line_of("link", link.name, "mass")) + "the mass of the link " + link.name +
                      " is " + show(link.inertial->mass) + "; expected 0 or more, kg");
    std::string name = link.name;
    Pose place;
    if (has_mass(link)) {
      LinkDef def;
      def.name = link.name;
      def.parent = owner;
      if (!root)
        def.joint = joint_of(*link.parent_joint, part);
      else
        def.joint.kind = JointKind::weld;
      if (free_ && owner.empty()) {
        if (def.joint.kind != JointKind::weld)
          throw UserError(
              at(line_of("joint", link.parent_joint->name)) + "the joint " +
              link.parent_joint->name +
              " moves the first link with a mass of a free robot; expected a fixed one");
        // the robot's frame is that of its first link
        first_ = def.joint.placement;
        def.joint = JointSpec();
      }
      set_mass(*link.inertial, link.name, def.body);
      robot_.links.push_back(def);
      add_shapes(link, Pose{}, shapes_.emplace_back());
      if (robot_.links.size() == 1)
        for (const auto& [part_link, where] : std::exchange(waiting_, {}))
          add_part(*part_link, owner, where);
    } else {
      // a part of its parent
      name = owner;
      place = part;
      if (!root) {
        const JointSpec joint = joint_of(*link.parent_joint, part);
        if (joint.kind != JointKind::weld)
          throw UserError(at(line_of("link", link.name)) + "the link " + link.name +
                          " has no mass and is moved by the joint " + link.parent_joint->name +
                          "; expected <inertial> with a mass above 0, or a fixed joint");
        place = joint.placement;
      }
      add_part(link, owner, place);
    }
    for (const auto& child : link.child_links) add(*child, name, place);
  }

  void add_part(const urdf::Link& link, const std::string& owner, const Pose& place) {
    for (std::size_t i = 0; i < robot_.links.size(); ++i)
      if (robot_.links[i].name == owner) return add_shapes(link, place, shapes_[i]);
    if (free_) {
      // a part of the first link with a mass, which may come later
      if (shapes_.empty()) return waiting_.emplace_back(&link, place), void();
      return add_shapes(link, inverse(first_) * place, shapes_.front());
    }
    Shapes shapes;
    add_shapes(link, place, shapes);
    if (shapes.touching.empty()) return;
    stands_.insert(stands_.end(), shapes.touching.begin(), shapes.touching.end());
    BodyDef& stand = robot_.stand ? *robot_.stand : robot_.stand.emplace();
    if (stand.name.empty()) stand.name = link.name;
    if (shapes.color) stand.color = shapes.color;
    stand.fixed = true;
    stand.shape = together(stands_);
  }

  void set_mass(const urdf::Inertial& given, const std::string& link, BodyDef& body) const {
    const Pose origin = from(given.origin);
    Mat3 inertia;
    inertia << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz,
        given.iyz, given.izz;
    const Mat3 R = origin.q.toRotationMatrix(), turned = R * inertia * R.transpose();
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvalues();
    if (!(moments[0] > 0) || !(moments[2] <= (1 + 1e-6) * (moments[0] + moments[1])))
      throw UserError(at(line_of("link", link, "inertia")) + "the <inertia> of the link " + link +
                      " has the principal moments " + show(moments[0]) + ", " + show(moments[1]) +
                      ", " + show(moments[2]) +
                      " kg m^2; expected positive ones, none above the sum of the others");
    body.mass = given.mass;
    body.inertia = 0.5 * (turned + turned.transpose());
    body.center_of_mass = origin.p;
  }

  std::string file_;
  bool free_;
  TiXmlDocument xml_;
  urdf::ModelInterfaceSharedPtr model_;
  UrdfRobot robot_;
  std::vector<Shapes> shapes_;  // of each link
  std::vector<ShapePtr> stands_;
  std::set<std::string> added_;
  // of a free robot: its first link in the root's frame, and parts of it that came before
  Pose first_;
  std::vector<std::pair<const urdf::Link*, Pose>> waiting_;
};

}  // namespace

UrdfRobot read_urdf(const std::string& file, bool free) { return Reader(file, free).read(); }

}  // namespace tw
