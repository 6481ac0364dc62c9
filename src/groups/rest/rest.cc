// Rest.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/rest/rest.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "groups/joints/joined.h"
#include "multibody/multibody.h"

namespace tw {
namespace {

// How far it reaches: of a link without a shape, to the next joint.
double reach_of(const Body& body) { return body.multibody ? extent_of_link(body) : body.extent(); }

// What the body falls through its own size at, m/s.
double speed_scale(const Scene& scene, const Body& body) {
  const double size = body.shape_P ? body.least_width : reach_of(body);
  return std::sqrt(scene.gravity_scale() * size);
}

// How long it is watched at least, s.
double least_watch(const Scene& scene, const Body& body) {
  return answer::watch_times * std::sqrt(reach_of(body) / scene.gravity_scale());
}

// Watched to the end, and stopped, or, where it touches anything, settling or trembling in its
// place: what swings a little on a joint or a spring swings on.
bool is_still(const Scene& scene, const Stillness& book, const PlacedBody& body, double now,
              bool touches) {
  const double age = now - book.since;
  if (book.since == never || age < book.length) return false;
  const double peak = std::max(book.early_peak, book.late_peak);
  const double share = peak / speed_scale(scene, *body.body);
  const bool settles = book.late_peak <= answer::settling * book.early_peak;
  // what gets faster, however slowly, goes on
  if (!touches)
    return share <= answer::stopped_share || (settles && share <= answer::rounding_share);
  if (settles || share <= answer::rounding_share) return true;
  if (book.late_peak > answer::growth * book.early_peak) return false;
  const double way =
      (body.point.x - book.x).norm() + body.point.q.angularDistance(book.q) * body.body->radius;
  return way <= answer::drift * peak * age;
}

// Whether a body keeps those awake that it touches.
bool is_restless(const Regrouping& work, const std::vector<Stillness>& stillness, BodyId id) {
  const Body& body = work.scene().body(id);
  if (!body.dynamic()) return !body.fixed();
  const Successor* successor = work.successor_of(id);
  if (work.changes(successor)) return stillness[work.place_of(successor)].since == never;
  return !successor->data.group || !successor->data.group->at_rest;
}

// Of each component: how many move, and how many of these can rest.
struct Share {
  std::size_t moving = 0, resting = 0;

  bool worth_a_border() const {
    return resting >= answer::least_resting &&
           static_cast<double>(resting) >=
               answer::least_resting_share * static_cast<double>(moving);
  }
};

}  // namespace

Stillness stillness_of(const Regrouping& work, const Successor& successor, bool touches) {
  const PlacedBody body = placed(successor);
  const double now = work.now();
  const double speed = body.point.v.norm() + body.point.w.norm() * reach_of(*body.body);
  if (speed >= answer::slow_share * speed_scale(work.scene(), *body.body)) return {};
  const Stillness begun{now,         least_watch(work.scene(), *body.body), speed, 0, body.point.x,
                        body.point.q};
  const Group* group = successor.data.group.get();
  // where forces were changed from outside, what was seen before says nothing
  const bool goes_on = work.cause() != Cause::callback && work.cause() != Cause::edit;
  if (!goes_on || !group || group->at_rest) return begun;
  Stillness book = group->stillness[successor.data.member];
  if (book.since == never) return begun;
  const double age = now - book.since;
  // what has come to a stop within a long watch need not wait for its end
  const double rounding = answer::rounding_share * speed_scale(work.scene(), *body.body);
  if (book.length > begun.length && speed <= rounding &&
      std::max(book.early_peak, book.late_peak) > rounding)
    return begun;
  double& peak = age < 0.5 * book.length ? book.early_peak : book.late_peak;
  peak = std::max(peak, speed);
  if (age < book.length || is_still(work.scene(), book, body, now, touches)) return book;
  if (book.late_peak > answer::growth * book.early_peak) return begun;
  if (!touches) {
    // a longer look at what decays slowly
    Stillness longer = begun;
    longer.length = 2 * book.length;
    return longer;
  }
  book.early_peak = std::max(book.early_peak, std::exchange(book.late_peak, 0));
  book.length *= 2;
  return book;
}

std::vector<bool> who_rests(const Regrouping& work, const Contacts& contacts,
                            const Watched& watched, Components& together) {
  const std::size_t count = work.successors.size();
  std::vector<bool> rests(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    const Successor& successor = work.successors[i];
    // what a spring pulls that moves at its other end waits for that, as what hangs on such a base
    const ForcesPtr& forces = successor.data.forces;
    const Multibody* multibody = successor.body->multibody;
    const bool carried = multibody && multibody->base_motion;
    rests[i] = work.changes(&successor) && (!forces || forces->longest_unlooked() == never) &&
               !carried &&
               is_still(work.scene(), watched.stillness[i], placed(successor), work.now(),
                        watched.touching[i]);
  }

  const auto wake = [&](BodyId id) {
    const Successor* successor = work.successor_of(id);
    if (work.changes(successor)) rests[work.place_of(successor)] = false;
  };
  for (const ContactPair& pair : contacts.pairs) {
    if (pair.count == 0) continue;
    for (const BodyId id : {pair.a(), pair.b()})
      if (is_restless(work, watched.stillness, id) || contacts.pushes_apart(work.scene(), pair))
        wake(pair.other(id));
  }

  // what is tied together rests together
  Components tied(count);
  visit_joined(work, [&](std::size_t i, std::size_t j) { tied.join(i, j); });
  for (std::size_t i = 0; i < count; ++i)
    if (work.changes(&work.successors[i]) && !rests[i]) rests[tied.root(i)] = false;
  for (std::size_t i = 0; i < count; ++i) rests[i] = rests[i] && rests[tied.root(i)];

  std::vector<Share> shares(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!work.changes(&work.successors[i])) continue;
    Share& share = shares[together.root(i)];
    ++share.moving;
    share.resting += rests[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Share& share = shares[together.root(i)];
    if (share.resting < share.moving && !share.worth_a_border()) rests[i] = false;
  }
  return rests;
}

}  // namespace tw
