// Robots from URDF files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "import/find-mesh.h"
#include "import/mesh-file.h"
#include "import/surface-file.h"
#include "import/urdf-file.h"

namespace tw {

using multibody::AxisSpec;
using multibody::JointKind;
using multibody::JointSpec;
using urdf::GeometryKind;
using urdf::JointType;

namespace {

Pose inverse(const Pose& pose) {
  const Quat q = pose.q.conjugate();
  return {-(q * pose.p), q};
}

// A ball of water, where nothing says how mass is spread.
Mat3 inertia_of_ball(double mass) {
  const double radius = std::cbrt(3 * mass / (4 * std::numbers::pi * 1000));
  return 0.4 * mass * radius * radius * Mat3::Identity();
}

class Builder {
 public:
  Builder(const std::string& file, const UrdfOptions& options, Mending& mending)
      : file_(file), options_(options), mending_(mending), model_(urdf::read_file(file, mending)) {}

  UrdfRobot build();

 private:
  // What a link is made of so far: its own shapes and those of parts without mass.
  struct Shapes {
    std::vector<ShapePtr> touching;
    Visual visual;
    std::optional<Vec3> color;
  };
  static constexpr std::size_t base = static_cast<std::size_t>(-1), none = base - 1;

  // ---- places ----

  std::string at(int line) const { return file_ + ":" + std::to_string(line) + ": "; }
  [[noreturn]] void fail(int line, const std::string& what) const {
    throw UserError(at(line) + what);
  }
  void mend(int line, const std::string& wrong, const std::string& done,
            const std::string& expected) {
    mending_.mend(at(line), wrong, done, expected);
  }

  // ---- the tree ----

  void connect();
  std::size_t find_root() const;
  const urdf::Link& link(std::size_t i) const { return model_.links[i]; }
  const urdf::Joint& joint(std::size_t i) const { return model_.joints[i]; }
  bool has_mass(std::size_t i) const { return link(i).inertial && link(i).inertial->mass > 0; }
  bool moves(std::size_t link) const {
    return joint_of_[link] != none && specs_[joint_of_[link]].kind != JointKind::weld;
  }
  bool root_hangs_alone() const;
  double total_mass() const;

  // ---- joints ----

  JointSpec spec_of(const urdf::Joint& joint);
  void set_limits(const urdf::Joint& joint, JointSpec& spec);
  static void lock(JointSpec& spec, double position);
  void set_followers();

  // ---- shapes ----

  ShapePtr shape_of(const urdf::Geometry& geometry);
  ShapePtr placed_shape(const urdf::Piece& piece, const Pose& part, const std::string& link);
  void add_shapes(const urdf::Link& link, const Pose& part, Shapes& shapes);
  VisualPart seen_part(const urdf::Piece& visual, const Pose& part);
  static VisualPtr visual_of(Visual visual);
  static ShapePtr together(const std::vector<ShapePtr>& shapes) {
    if (shapes.empty()) return nullptr;
    return shapes.size() == 1 ? shapes.front() : make_union(shapes);
  }
  void finish(std::size_t number);

  // ---- links ----

  void add(std::size_t link, std::size_t owner, const Pose& part);
  void add_part(std::size_t link, std::size_t owner, const Pose& place);
  void make_stand();
  std::size_t add_link(std::size_t link, std::size_t owner, JointSpec spec);
  void add_planar(const urdf::Joint& joint, std::size_t& owner, JointSpec& spec);
  void set_mass(const urdf::Link& link, LinkDef& def);

  const std::string& file_;
  const UrdfOptions& options_;
  Mending& mending_;
  urdf::Robot model_;
  std::map<std::string, std::size_t> links_;        // by name
  std::vector<std::size_t> joint_of_;               // that moves a link; none: of the root
  std::vector<std::vector<std::size_t>> children_;  // joints, of a link
  std::vector<JointSpec> specs_;                    // of each joint
  std::map<std::size_t, double> locked_at_;         // joints whose limits are equal
  std::size_t root_ = 0;
  bool root_is_link_ = false;
  double mass_ = 0;  // of the robot, kg

  UrdfRobot robot_;
  std::vector<Shapes> shapes_;              // of each link of the robot
  std::vector<const urdf::Link*> sources_;  // null: of a planar joint's inside
  Shapes stand_;                            // what is fixed to the base, and the first link of it
  std::string stand_name_;
  std::map<std::string, std::vector<Vec3>> points_;  // of mesh files
  std::map<std::tuple<std::string, double, double, double>, std::shared_ptr<const SurfaceMesh>>
      surfaces_;  // by file and scale
  // of a free robot: its first link in the root's frame, and parts of it that came before
  Pose first_;
  std::vector<std::pair<std::size_t, Pose>> waiting_;
};

// ---- the tree ----

void Builder::connect() {
  joint_of_.assign(model_.links.size(), none);
  children_.resize(model_.links.size());
  for (std::size_t i = 0; i < model_.links.size(); ++i)
    if (!links_.emplace(link(i).name, i).second)
      fail(link(i).line, "two links are called " + link(i).name + "; expected a name to each");
  std::map<std::string, int> lines;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const urdf::Joint& j = joint(i);
    if (!lines.emplace(j.name, j.line).second)
      fail(j.line, "two joints are called " + j.name + "; expected a name to each");
    const auto find = [&](const char* which, const std::string& name) {
      const auto found = links_.find(name);
      if (found == links_.end())
        fail(j.line, std::string("the ") + which + " of the joint " + j.name + " is " + name +
                         ", which is no link of the robot; expected the name of a <link>");
      return found->second;
    };
    const std::size_t parent = find("parent", j.parent), child = find("child", j.child);
    if (joint_of_[child] != none)
      fail(j.line, "the link " + j.child + " is the child of two joints, " +
                       joint(joint_of_[child]).name + " and " + j.name + "; expected one");
    joint_of_[child] = i;
    children_[parent].push_back(i);
  }
  root_ = find_root();
}

std::size_t Builder::find_root() const {
  std::size_t found = none;
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    if (joint_of_[i] != none) continue;
    if (found != none)
      fail(link(i).line, "the robot has two roots, " + link(found).name + " and " + link(i).name +
                             ", which are children of no joint; expected one tree of joints");
    found = i;
  }
  if (found == none)
    fail(link(0).line, "every link is the child of a joint; expected a tree, without cycles");
  std::vector<bool> reached(model_.links.size());
  std::vector<std::size_t> open{found};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    reached[at] = true;
    for (const std::size_t j : children_[at]) open.push_back(links_.at(joint(j).child));
  }
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (!reached[i])
      fail(link(i).line, "the link " + link(i).name + " does not hang on the root, " +
                             link(found).name + "; expected a tree of joints, without cycles");
  return found;
}

double Builder::total_mass() const {
  double sum = 0;
  for (const urdf::Link& l : model_.links)
    if (l.inertial) sum += l.inertial->mass;
  return sum;
}

// Whether of a free robot exactly one link with a mass is fixed to the root, or is it: what comes
// before is a part of that.
bool Builder::root_hangs_alone() const {
  std::size_t first = 0;
  std::vector<std::size_t> open{root_};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (moves(at)) return false;
    if (has_mass(at)) {
      ++first;
      continue;
    }
    for (const std::size_t j : children_[at]) open.push_back(links_.at(joint(j).child));
  }
  return first == 1;
}

// ---- joints ----

void Builder::set_limits(const urdf::Joint& joint, JointSpec& spec) {
  AxisSpec& axis = spec.axes[0];
  if (joint.limit) {
    // nobody means that a joint can do nothing
    if (joint.limit->effort.value_or(0) > 0) axis.effort = *joint.limit->effort;
    if (joint.limit->velocity.value_or(0) > 0) axis.speed = *joint.limit->velocity;
  }
  if (joint.type != JointType::revolute && joint.type != JointType::prismatic) return;
  const std::string of = "the joint " + joint.name;
  // one that follows another has the limits of that, at least
  const bool limited = joint.limit && (joint.limit->lower || joint.limit->upper);
  if (joint.mimic && !limited) return;
  if (!joint.limit) {
    mend(joint.line, of + " has no <limit>", "it moves without end",
         "<limit lower=\"...\" upper=\"...\"/>");
    return;
  }
  const double lower = joint.limit->lower.value_or(0), upper = joint.limit->upper.value_or(0);
  if (lower < upper) {
    axis.lower = lower, axis.upper = upper;
    return;
  }
  const std::string are =
      "the limits of " + of + " are " +
      (joint.limit->lower || joint.limit->upper ? show(lower) + " and " + show(upper)
                                                : "not given, and so 0 and 0");
  constexpr const char* expected = "a lower one and a greater upper one";
  if (lower > upper) {
    mend(joint.limit->line, are, "it has none", expected);
    return;
  }
  mend(joint.limit->line, are, "it is locked", expected);
  lock(spec, lower);
  locked_at_[static_cast<std::size_t>(&joint - model_.joints.data())] = lower;
}

void Builder::lock(JointSpec& spec, double position) {
  const Vec3 unit = spec.axis.normalized();
  const Pose there = spec.kind == JointKind::revolute
                         ? Pose{Vec3::Zero(), Quat(Eigen::AngleAxisd(position, unit))}
                         : Pose{position * unit, Quat::Identity()};
  spec.placement = spec.placement * there;
  spec.kind = JointKind::weld;
}

JointSpec Builder::spec_of(const urdf::Joint& joint) {
  JointSpec spec;
  switch (joint.type) {
    case JointType::fixed: spec.kind = JointKind::weld; break;
    case JointType::revolute:
    case JointType::continuous:
    case JointType::planar: spec.kind = JointKind::revolute; break;
    case JointType::prismatic: spec.kind = JointKind::prismatic; break;
    case JointType::spherical: spec.kind = JointKind::spherical; break;
    case JointType::floating: spec.kind = JointKind::free; break;
  }
  spec.name = joint.name;
  spec.placement = joint.origin;
  spec.axis = joint.axis;
  if (spec.kind == JointKind::weld) return spec;
  if (spec.kind != JointKind::free && spec.kind != JointKind::spherical && !(spec.axis.norm() > 0))
    fail(joint.line, "the axis of the joint " + joint.name + " is 0 0 0; expected a direction");
  for (const auto& [value, name, member] :
       {std::tuple(joint.damping, "damping", &AxisSpec::damping),
        std::tuple(joint.friction, "friction", &AxisSpec::friction)}) {
    if (value < 0)
      mend(joint.line, std::string(name) + " of the joint " + joint.name + " is " + show(value),
           "it has none", "0 or more");
    spec.axes[0].*member = std::max(0.0, value);
  }
  set_limits(joint, spec);
  return spec;
}

// Which joints follow which: those at the ends of chains, whose limits are those of all that
// follow; what follows a joint that is locked is locked, too.
void Builder::set_followers() {
  std::map<std::string, std::size_t> names;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) names[joint(i).name] = i;
  const auto one_freedom = [&](std::size_t i) {
    return specs_[i].kind == JointKind::revolute || specs_[i].kind == JointKind::prismatic;
  };
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    if (!joint(i).mimic || specs_[i].kind == JointKind::weld) continue;
    multibody::FollowSpec follows{joint(i).name, 1, 0};
    std::size_t leader = i, steps = 0;
    std::string wrong;
    while (joint(leader).mimic && specs_[leader].kind != JointKind::weld) {
      const urdf::Mimic& mimic = *joint(leader).mimic;
      const auto found = names.find(mimic.joint);
      if (found == names.end())
        wrong = mimic.joint + ", which is no joint of the robot";
      else if (++steps > model_.joints.size())
        wrong = mimic.joint + ", and so itself";
      if (!wrong.empty()) break;
      follows.offset += follows.ratio * mimic.offset;
      follows.ratio *= mimic.multiplier;
      leader = found->second;
    }
    if (!wrong.empty()) {
      mend(joint(i).mimic->line, "the joint " + joint(i).name + " follows " + wrong,
           "it moves by itself", "the name of a joint that moves by itself");
      continue;
    }
    follows.joint = joint(leader).name;
    JointSpec& own = specs_[i];
    JointSpec& leads = specs_[leader];
    if (leads.kind == JointKind::weld) {
      const double position = follows.offset + follows.ratio * locked_at_[leader];
      mend(joint(i).mimic->line,
           "the joint " + joint(i).name + " follows " + follows.joint + ", which does not move",
           "it is locked at " + show(position), "the name of a joint that moves by itself");
      lock(own, position);
      continue;
    }
    if (!one_freedom(i) || !one_freedom(leader) || joint(i).type == JointType::planar ||
        joint(leader).type == JointType::planar)
      fail(joint(i).mimic->line, "the joint " + joint(i).name + " follows " + follows.joint +
                                     "; expected two joints that turn or slide");
    AxisSpec& axis = own.axes[0];
    AxisSpec& most = leads.axes[0];
    if (follows.ratio != 0) {
      const double a = (axis.lower - follows.offset) / follows.ratio;
      const double b = (axis.upper - follows.offset) / follows.ratio;
      const double lower = std::max(most.lower, std::min(a, b));
      const double upper = std::min(most.upper, std::max(a, b));
      if (lower < upper)
        most.lower = lower, most.upper = upper;
      else
        mend(joint(i).mimic->line,
             "the limits of the joint " + joint(i).name + " leave nothing to " + follows.joint +
                 ", which it follows",
             "it has none", "limits that both can keep");
    }
    axis.lower = -std::numeric_limits<double>::infinity();
    axis.upper = std::numeric_limits<double>::infinity();
    own.follows = follows;
  }
}

// ---- shapes ----

ShapePtr Builder::shape_of(const urdf::Geometry& geometry) {
  switch (geometry.kind) {
    case GeometryKind::sphere: return make_sphere(geometry.radius);
    case GeometryKind::box: return make_box(geometry.size);
    case GeometryKind::cylinder: return make_cylinder(geometry.radius, geometry.length);
    case GeometryKind::capsule: return make_capsule(geometry.radius, geometry.length);
    case GeometryKind::plane: return make_half_space(geometry.size.normalized(), 0);
    case GeometryKind::mesh: break;
  }
  const std::string path = find_mesh(geometry.file, file_, options_.packages);
  auto found = points_.find(path);
  if (found == points_.end()) found = points_.emplace(path, mesh_points(path)).first;
  std::vector<Vec3> points = found->second;
  for (Vec3& p : points) p = p.cwiseProduct(geometry.size);
  return make_hull(points);
}

ShapePtr Builder::placed_shape(const urdf::Piece& piece, const Pose& part,
                               const std::string& link) {
  try {
    return place_shape(shape_of(piece.geometry), part * piece.origin);
  } catch (const UserError& error) {
    const bool mesh = piece.geometry.kind == GeometryKind::mesh;
    if (mesh && find_mesh(piece.geometry.file, file_, options_.packages) == piece.geometry.file &&
        piece.geometry.file.find("://") != std::string::npos)
      fail(piece.geometry.line, "<mesh> of the link " + link + ": the mesh " + piece.geometry.file +
                                    " is missing; expected the package in a folder above the "
                                    "file, or in one of #:package-path");
    fail(piece.geometry.line,
         std::string(mesh ? "<mesh>" : "a shape") + " of the link " + link + ": " + error.what());
  }
}

// Shapes of a link that lies at `part` in what it belongs to.
void Builder::add_shapes(const urdf::Link& link, const Pose& part, Shapes& shapes) {
  const std::size_t touching_before = shapes.touching.size();
  const std::size_t seen_before = shapes.visual.size();
  for (const urdf::Piece& collision : link.collisions)
    shapes.touching.push_back(placed_shape(collision, part, link.name));
  for (const urdf::Piece& visual : link.visuals) {
    if (visual.color && !shapes.color) shapes.color = visual.color;
    try {
      shapes.visual.push_back(seen_part(visual, part));
    } catch (const UserError& error) {
      mending_.mend(at(visual.geometry.line), "<visual> of the link " + link.name + ": ", error,
                    "it is not drawn");
    }
  }
  // one whose visuals are all missing is drawn as what touches
  if (link.visuals.empty() || shapes.visual.size() > seen_before) return;
  for (std::size_t i = touching_before; i < shapes.touching.size(); ++i)
    shapes.visual.push_back({shapes.touching[i], nullptr, Pose{}, std::nullopt});
}

VisualPart Builder::seen_part(const urdf::Piece& visual, const Pose& part) {
  VisualPart seen;
  TW_REQUIRE(visual.geometry.kind != GeometryKind::plane,
             "a <plane> is drawn where it is a <collision> alone; expected another shape");
  seen.pose = part * visual.origin;
  seen.color = visual.color;
  const urdf::Geometry& geometry = visual.geometry;
  if (geometry.kind != GeometryKind::mesh) {
    seen.shape = shape_of(geometry);
    return seen;
  }
  const std::string path = find_mesh(geometry.file, file_, options_.packages);
  const auto key = std::tuple(path, geometry.size.x(), geometry.size.y(), geometry.size.z());
  auto found = surfaces_.find(key);
  if (found == surfaces_.end())
    found = surfaces_.emplace(key, read_surface(path, geometry.size, false)).first;
  seen.mesh = found->second;
  return seen;
}

VisualPtr Builder::visual_of(Visual visual) {
  return visual.empty() ? nullptr : std::make_shared<const Visual>(std::move(visual));
}

void Builder::finish(std::size_t number) {
  const Shapes& shapes = shapes_[number];
  LinkDef& def = robot_.links[number];
  def.body.color = shapes.color;
  def.body.shape = together(shapes.touching);
  def.body.visual = visual_of(shapes.visual);
  if (sources_[number]) set_mass(*sources_[number], def);
}

// ---- links ----

void Builder::set_mass(const urdf::Link& link, LinkDef& def) {
  BodyDef& body = def.body;
  const std::string of = "the link " + link.name;
  if (!link.inertial || link.inertial->mass == 0) {
    body.mass = 1e-3 * mass_;
    body.inertia = inertia_of_ball(*body.mass);
    body.center_of_mass = Vec3::Zero();
    mend(link.inertial ? link.inertial->mass_line : link.line, of + " moves, and has no mass",
         "it has " + show(*body.mass) + " kg, a thousandth of the robot's",
         "<inertial> with a mass above 0, or a fixed joint");
    return;
  }
  const urdf::Inertial& given = *link.inertial;
  body.mass = given.mass;
  body.center_of_mass = given.origin.p;
  const auto from_shapes = [&](int line, const std::string& wrong) {
    const bool shaped = body.shape && body.shape->bounded() && !body.shape->is_ground();
    mend(line, wrong,
         shaped ? "it is that of its shapes" : "it is that of a ball of water, as it has no shape",
         "<inertia> with ixx, iyy and izz, positive, none above the sum of the others");
    if (!shaped) body.inertia = inertia_of_ball(given.mass);
  };
  if (!given.inertia) return from_shapes(given.line, of + " has no <inertia>");
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(*given.inertia);
  Vec3 moments = solver.eigenvalues();
  const std::string wrong = "the <inertia> of " + of + " has the principal moments " +
                            show(moments[0]) + ", " + show(moments[1]) + ", " + show(moments[2]) +
                            " kg m^2";
  if (!(moments[0] > 1e-9 * moments[2])) return from_shapes(given.inertia_line, wrong);
  // the nearest that a body has: the trace stays
  const double beyond = moments[2] - moments[0] - moments[1];
  if (beyond > 1e-9 * moments[2]) moments += beyond / 3 * Vec3(1, 1, -1);
  const Mat3 R = given.origin.q.toRotationMatrix();
  Mat3 inertia = *given.inertia;
  if (beyond > 1e-9 * moments[2])
    inertia = solver.eigenvectors() * moments.asDiagonal() * solver.eigenvectors().transpose();
  if (beyond > 1e-6 * moments[2])
    mend(given.inertia_line, wrong,
         "they are " + show(moments[0]) + ", " + show(moments[1]) + ", " + show(moments[2]),
         "positive ones, none above the sum of the others");
  inertia = R * inertia * R.transpose();
  body.inertia = 0.5 * (inertia + inertia.transpose());
}

std::size_t Builder::add_link(std::size_t number, std::size_t owner, JointSpec spec) {
  LinkDef def;
  def.name = link(number).name;
  if (owner != base) def.parent = robot_.links[owner].name;
  def.joint = std::move(spec);
  robot_.links.push_back(std::move(def));
  sources_.push_back(&link(number));
  add_shapes(link(number), Pose{}, shapes_.emplace_back());
  return robot_.links.size() - 1;
}

// Two slides square to the axis come before the turn about it.
void Builder::add_planar(const urdf::Joint& joint, std::size_t& owner, JointSpec& spec) {
  const Vec3 axis = spec.axis.normalized();
  const Vec3 x = axis.unitOrthogonal();
  for (const auto& [suffix, along] : {std::pair("/x", x), std::pair("/y", Vec3(axis.cross(x)))}) {
    LinkDef def;
    def.name = joint.name + suffix;
    if (owner != base) def.parent = robot_.links[owner].name;
    def.joint = spec;
    def.joint.name = def.name;
    def.joint.kind = JointKind::prismatic;
    def.joint.axis = along;
    def.body.mass = 1e-3 * mass_;
    def.body.inertia = inertia_of_ball(*def.body.mass);
    def.body.center_of_mass = Vec3::Zero();
    robot_.links.push_back(std::move(def));
    sources_.push_back(nullptr);
    shapes_.emplace_back();
    owner = robot_.links.size() - 1;
    spec.placement = Pose{};
  }
  mend(joint.line, "the joint " + joint.name + " is planar",
       "it is two slides, " + joint.name + "/x and " + joint.name +
           "/y, that weigh a thousandth of the robot, and a turn",
       "two prismatic joints and a revolute one");
}

// The link and what hangs on it.  `owner`: the robot's link that its parent is, or is a part of,
// which has the parent's frame at `part`; or the base.
void Builder::add(std::size_t number, std::size_t owner, const Pose& part) {
  struct Open {
    std::size_t link, owner;
    Pose part;
  };
  std::vector<Open> open{{number, owner, part}};
  while (!open.empty()) {
    Open at = open.back();
    open.pop_back();
    const bool root = at.link == root_;
    JointSpec spec;
    spec.kind = JointKind::weld;
    if (!root) {
      spec = specs_[joint_of_[at.link]];
      spec.placement = at.part * spec.placement;
    }
    std::size_t mine = at.owner;
    Pose place = root ? Pose{} : spec.placement;
    if (has_mass(at.link) || moves(at.link) || (root && root_is_link_)) {
      const bool first_of_free = robot_.free && robot_.links.empty();
      if (!root && joint(joint_of_[at.link]).type == JointType::planar)
        add_planar(joint(joint_of_[at.link]), at.owner, spec);
      if (first_of_free) {
        // the robot's frame is that of its first link
        first_ = spec.placement;
        spec = JointSpec();
      }
      mine = add_link(at.link, at.owner, spec);
      if (first_of_free)
        for (const auto& [other, where] : std::exchange(waiting_, {})) add_part(other, base, where);
      place = Pose{};
    } else {
      add_part(at.link, at.owner, place);
    }
    for (auto child = children_[at.link].rbegin(); child != children_[at.link].rend(); ++child)
      open.push_back({links_.at(joint(*child).child), mine, place});
  }
}

void Builder::add_part(std::size_t number, std::size_t owner, const Pose& place) {
  if (owner != base) return add_shapes(link(number), place, shapes_[owner]);
  if (robot_.free) {
    // a part of the first link with a mass, which may come later
    if (shapes_.empty()) return waiting_.emplace_back(number, place), void();
    return add_shapes(link(number), inverse(first_) * place, shapes_.front());
  }
  if (stand_.touching.empty() && stand_.visual.empty()) stand_name_ = link(number).name;
  add_shapes(link(number), place, stand_);
}

void Builder::make_stand() {
  if (stand_.touching.empty() && stand_.visual.empty()) return;
  BodyDef& stand = robot_.stand.emplace();
  stand.name = stand_name_;
  stand.color = stand_.color;
  stand.fixed = true;
  stand.shape = together(stand_.touching);
  stand.visual = visual_of(stand_.visual);
}

UrdfRobot Builder::build() {
  connect();
  mass_ = total_mass();
  for (const urdf::Joint& j : model_.joints) specs_.push_back(spec_of(j));
  set_followers();
  // a world of its own that the robot floats in
  bool floats = false;
  const std::vector<std::size_t>& first = children_[root_];
  for (std::size_t i = 0; i < specs_.size(); ++i) {
    if (specs_[i].kind != JointKind::free) continue;
    if (first.size() != 1 || first[0] != i || has_mass(root_) || !link(root_).collisions.empty())
      fail(joint(i).line, "the joint " + joint(i).name +
                              " is floating; expected so that of a link on an empty root alone");
    floats = true;
    specs_[i].kind = JointKind::weld;
  }
  bool moving = false;
  for (std::size_t i = 0; i < model_.links.size(); ++i) moving = moving || moves(i);
  robot_.name = model_.name.empty() ? link(root_).name : model_.name;
  robot_.free = options_.base == UrdfBase::free ||
                (options_.base == UrdfBase::automatic && (floats || (!moving && mass_ > 0)));
  if (robot_.free || moving)
    if (!(mass_ > 0))
      fail(link(root_).line, "the robot " + robot_.name +
                                 " has no link with a mass; expected one or more with <inertial>");
  root_is_link_ = robot_.free && !root_hangs_alone();
  if (!robot_.free && !moving) {
    // scenery
    for (urdf::Link& l : model_.links) l.inertial.reset();
  }
  add(root_, base, Pose{});
  for (std::size_t i = 0; i < shapes_.size(); ++i) finish(i);
  make_stand();
  if (robot_.links.empty() && !robot_.stand)
    fail(link(root_).line, "the robot " + robot_.name +
                               " has no link with a mass, and none with <collision>; expected one "
                               "or the other");
  return std::move(robot_);
}

}  // namespace

UrdfRobot read_urdf(const std::string& file, const UrdfOptions& options, Mending& mending) {
  return Builder(file, options, mending).build();
}

}  // namespace tw
