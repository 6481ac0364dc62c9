// Robots from URDF files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "import/urdf-file.h"
#include "import/urdf-joints.h"
#include "import/urdf-shapes.h"

namespace tw {

using multibody::JointKind;
using multibody::JointSpec;
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

class Builder : LineMending {
 public:
  Builder(const std::string& file, const UrdfOptions& options, Mending& mending)
      : LineMending(file, mending), options_(options), model_(urdf::read_file(file, mending)) {}

  UrdfRobot build();

 private:
  static constexpr std::size_t base = static_cast<std::size_t>(-1), none = base - 1;

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

  // ---- links ----

  void add(std::size_t link, std::size_t owner, const Pose& part);
  void add_part(std::size_t link, std::size_t owner, const Pose& place);
  void make_stand();
  std::size_t add_link(std::size_t link, std::size_t owner, JointSpec spec);
  void add_planar(const urdf::Joint& joint, std::size_t& owner, JointSpec& spec);
  void set_mass(const urdf::Link& link, LinkDef& def);
  void finish(std::size_t number);

  const UrdfOptions& options_;
  urdf::Robot model_;
  std::map<std::string, std::size_t> links_;        // by name
  std::vector<std::size_t> joint_of_;               // that moves a link; none: of the root
  std::vector<std::vector<std::size_t>> children_;  // joints, of a link
  std::vector<JointSpec> specs_;                    // of each joint
  std::size_t root_ = 0;
  bool root_is_link_ = false;
  double mass_ = 0;  // of the robot, kg

  UrdfRobot robot_;
  urdf::Shapes shapes_{file_, options_.packages, mending_};
  std::vector<urdf::BodyPieces> pieces_;    // of each link of the robot
  std::vector<const urdf::Link*> sources_;  // null: of a planar joint's inside
  urdf::BodyPieces stand_;                  // what is fixed to the base, and the first link of it
  std::string stand_name_;
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
  shapes_.add(link(number), Pose{}, pieces_.emplace_back());
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
    pieces_.emplace_back();
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
  if (owner != base) return shapes_.add(link(number), place, pieces_[owner]);
  if (robot_.free) {
    // a part of the first link with a mass, which may come later
    if (pieces_.empty()) return waiting_.emplace_back(number, place), void();
    return shapes_.add(link(number), inverse(first_) * place, pieces_.front());
  }
  if (stand_.empty()) stand_name_ = link(number).name;
  shapes_.add(link(number), place, stand_);
}

void Builder::finish(std::size_t number) {
  LinkDef& def = robot_.links[number];
  def.body.color = pieces_[number].color;
  const urdf::BodyLooks looks = shapes_.finish(std::move(pieces_[number]), false);
  def.body.shape = looks.shape;
  def.body.visual = looks.visual;
  if (sources_[number]) set_mass(*sources_[number], def);
}

void Builder::make_stand() {
  if (stand_.empty()) return;
  BodyDef& stand = robot_.stand.emplace();
  stand.name = stand_name_;
  stand.color = stand_.color;
  stand.fixed = true;
  const bool scenery = robot_.links.empty();
  const urdf::BodyLooks looks = shapes_.finish(std::move(stand_), scenery);
  stand.shape = looks.shape;
  stand.visual = looks.visual;
}

UrdfRobot Builder::build() {
  connect();
  mass_ = total_mass();
  specs_ = urdf::joint_specs(file_, model_, mending_);
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
  for (std::size_t i = 0; i < pieces_.size(); ++i) finish(i);
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
