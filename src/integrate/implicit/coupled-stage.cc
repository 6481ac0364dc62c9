// The linear systems of groups with multibodies.
//
// A column of the matrix is what one unknown, set to 1, takes from its own equations and gives to
// the wrenches of all contacts that it moves: the same changes, in the same functions, as when a
// stage is solved.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "integrate/implicit/group-rows.h"
#include "integrate/implicit/group-system.h"

namespace tw {

using namespace rows;

namespace {

void insert_all(std::vector<int>& row, const std::vector<int>& more) {
  row.insert(row.end(), more.begin(), more.end());
}
void tidy_row(std::vector<int>& row) {
  std::sort(row.begin(), row.end());
  row.erase(std::unique(row.begin(), row.end()), row.end());
}

}  // namespace

void GroupSystem::Couplings::add(const Couplings& more) {
  insert_all(packs, more.packs);
  insert_all(bonds, more.bonds);
}
void GroupSystem::Couplings::tidy() {
  tidy_row(packs);
  tidy_row(bonds);
}

template <class Visit>
void GroupSystem::each_slot(const Couplings& couplings, Visit&& visit) const {
  for (const int p : couplings.packs)
    for (int i = 0; i < packs_.packs[index(p)].count; ++i)
      for (const int slot : {packs_.packs[index(p)].a[i], packs_.packs[index(p)].b[i]}) visit(slot);
  for (const int number : couplings.bonds)
    for (const int slot : {bonds_[index(number)].given.a, bonds_[index(number)].given.b})
      visit(slot);
}

void GroupSystem::make_coupled() {
  int count = 0;
  for (Member& m : member_) {
    if (m.is_link) continue;
    m.unknown = count;
    count += 6;
  }
  for (const auto& tree : trees_) {
    tree_unknowns_.push_back(count);
    count += tree->freedoms();
  }

  // whom each contact and each bond moves
  couplings_of_slot_.assign(index(packs_.slots), {});
  for (int p = 0; p < packs(); ++p)
    for (int i = 0; i < packs_.packs[index(p)].count; ++i)
      for (const int slot : {packs_.packs[index(p)].a[i], packs_.packs[index(p)].b[i]})
        couplings_of_slot_[index(slot)].packs.push_back(p);
  for (int i = 0; i < static_cast<int>(bonds_.size()); ++i)
    for (const int slot : {bonds_[index(i)].given.a, bonds_[index(i)].given.b})
      couplings_of_slot_[index(slot)].bonds.push_back(i);
  for (Couplings& row : couplings_of_slot_) row.tidy();
  for (const auto& tree : trees_) {
    Couplings& all = couplings_of_tree_.emplace_back();
    for (const int member : tree->start().members) all.add(couplings_of_slot_[index(member)]);
    all.tidy();
  }

  if (CoupledMatrix::is_dense(count)) {
    coupled_ = std::make_unique<CoupledMatrix>(count);
    return;
  }

  // the unknowns of each slot, and the rows that each column may reach
  std::vector<std::vector<int>> unknowns(index(packs_.slots));
  const auto run = [](int first, int length) {
    std::vector<int> row(index(length));
    for (int i = 0; i < length; ++i) row[index(i)] = first + i;
    return row;
  };
  for (int i = 0; i < members_; ++i)
    if (!member_[index(i)].is_link) unknowns[index(i)] = run(member_[index(i)].unknown, 6);
  for (std::size_t t = 0; t < trees_.size(); ++t)
    for (const int member : trees_[t]->start().members)
      unknowns[index(member)] = run(tree_unknowns_[t], trees_[t]->freedoms());
  const auto reached = [&](std::vector<int> own, const Couplings& through) {
    each_slot(through, [&](int slot) { insert_all(own, unknowns[index(slot)]); });
    tidy_row(own);
    return own;
  };
  std::vector<std::vector<int>> rows_of(index(count));
  for (int i = 0; i < members_; ++i)
    if (!member_[index(i)].is_link)
      for (const int k : unknowns[index(i)])
        rows_of[index(k)] = reached(unknowns[index(i)], couplings_of_slot_[index(i)]);
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const std::vector<int> own = run(tree_unknowns_[t], trees_[t]->freedoms());
    for (const int k : own) rows_of[index(k)] = reached(own, couplings_of_tree_[t]);
  }
  coupled_ = std::make_unique<CoupledMatrix>(std::move(rows_of));
}

void GroupSystem::change_couplings(const Couplings& couplings, GroupScratch& s) const {
  for (const int p : couplings.packs) {
    const ContactPack& pack = packs_.packs[index(p)];
    const PackLinear& linear = s.linear[index(p)];
    if (linear.idle) continue;
    PackChange change;
    change_pack(pack, linear, s.changes.data(), {}, true, change);
    scatter_change(pack, linear, change, s.wrenches.data());
  }
  for (const int number : couplings.bonds) change_bond(number, s);
}

// What else acts on a member, by the changes in the scratch.
void GroupSystem::change_forced(int member, GroupScratch& s) const {
  if (!member_[index(member)].forces) return;
  const Vec6 wrench = change_of(s.members[index(member)].forced, s.changes[index(member)]);
  vec(s.wrenches[index(member)].f) += wrench.head<3>();
  vec(s.wrenches[index(member)].t) += wrench.tail<3>();
}

void GroupSystem::gather_column(const Couplings& couplings, GroupScratch& s,
                                std::span<const int> moved_members, double* column) const {
  // the bodies that these may move, in and out of the scratch
  each_slot(couplings, [&](int slot) { s.wrenches[index(slot)] = BodyWrench{}; });
  change_couplings(couplings, s);
  for (const int member : moved_members) change_forced(member, s);
  const auto take = [&](int slot) {
    if (slot >= members_) return;
    BodyWrench& wrench = s.wrenches[index(slot)];
    const Member& m = member_[index(slot)];
    if (m.is_link) return;
    vec(column + m.unknown) -= vec(wrench.f);
    vec(column + m.unknown + 3) -= vec(wrench.t);
    wrench = BodyWrench{};
  };
  each_slot(couplings, take);
  for (const int member : moved_members) take(member);
  thread_local std::vector<double> row;
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const auto& members = trees_[t]->start().members;
    const bool reached = std::any_of(members.begin(), members.end(), [&](int member) {
      const BodyWrench& w = s.wrenches[index(member)];
      return !vec(w.f).isZero(0) || !vec(w.t).isZero(0);
    });
    if (!reached) continue;
    row.assign(index(trees_[t]->freedoms()), 0.0);
    trees_[t]->gather(s.wrenches.data(), row.data());
    trees_[t]->fold(row.data());
    for (std::size_t k = 0; k < row.size(); ++k) column[index(tree_unknowns_[t]) + k] -= row[k];
    for (const int member : members) s.wrenches[index(member)] = BodyWrench{};
  }
}

bool GroupSystem::factor_coupled(GroupScratch& s) {
  for (int i = 0; i < members_; ++i)
    if (!member_[index(i)].is_link) s.members[index(i)].set_stage_rate(sigma_);
  for (const auto& tree : trees_) tree->set_stage_rate(sigma_);
  for (int p = 0; p < packs(); ++p)
    set_stage_rate(packs_.packs[index(p)], sigma_, s.linear[index(p)]);
  std::fill(s.changes.begin(), s.changes.begin() + packs_.slots, BodyChange{});
  std::fill(s.wrenches.begin(), s.wrenches.begin() + packs_.slots, BodyWrench{});

  thread_local std::vector<double> column, unit, kq;
  column.resize(index(coupled_->size()));
  const auto clear = [&](int k) {
    for (const int row : coupled_->rows_of(k)) column[index(row)] = 0;
  };
  for (int i = 0; i < members_; ++i) {
    const Member& m = member_[index(i)];
    if (m.is_link) continue;
    BodyChange& change = s.changes[index(i)];
    // of velocities and of angular momenta
    const double units[2] = {std::sqrt(m.inverse_mass),
                             1 / std::sqrt(m.inverse_moments.minCoeff())};
    for (int c = 0; c < 6; ++c) {
      clear(m.unknown + c);
      change = BodyChange{};
      if (c < 3) {
        change.x[c] = 1 / sigma_;
        change.v[c] = 1;
      } else {
        vec(change.th) = s.members[index(i)].P.col(c - 3);
        vec(change.w) = s.members[index(i)].V.col(c - 3);
      }
      column[index(m.unknown + c)] = (c < 3 ? m.mass : 1.0) * sigma_;
      gather_column(couplings_of_slot_[index(i)], s, {&i, 1}, column.data());
      coupled_->set_column(m.unknown + c, column.data(), units[c / 3]);
    }
    change = BodyChange{};
  }
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    TreeInGroup& tree = *trees_[t];
    const std::size_t n = index(tree.freedoms());
    unit.assign(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const int number = tree_unknowns_[t] + static_cast<int>(k);
      clear(number);
      unit[k] = 1;
      tree.follow(unit.data());
      kq = unit;
      tree.eliminate(kq.data());
      tree.spread(kq.data(), unit.data(), s.changes.data());
      gather_column(couplings_of_tree_[t], s, tree.start().members, column.data());
      for (std::size_t i = 0; i < n; ++i)
        column[index(tree_unknowns_[t]) + i] += tree.matrix()[n * k + i];
      const double own = std::abs(column[index(number)]);
      coupled_->set_column(number, column.data(), own > 0 ? std::sqrt(sigma_ / own) : 1);
      std::fill(unit.begin(), unit.end(), 0.0);
    }
    for (const int member : tree.start().members) s.changes[index(member)] = BodyChange{};
  }
  return coupled_->factor();
}

bool GroupSystem::solve_coupled(GroupScratch& s, double* stage) {
  std::fill(s.changes.begin() + members_, s.changes.begin() + packs_.slots, BodyChange{});
  std::fill(s.wrenches.begin(), s.wrenches.begin() + packs_.slots, BodyWrench{});

  // positions of the eliminated part
  for (int i = 0; i < members_; ++i) {
    if (!member_[index(i)].is_link)
      s.members[index(i)].eliminate(stage + 12 * i, s.changes[index(i)]);
  }
  thread_local std::vector<double> work;
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    double* r = stage + tree_rows_[t];
    work.assign(index(trees_[t]->freedoms()), 0.0);
    trees_[t]->eliminate(r);
    trees_[t]->spread(r, work.data(), s.changes.data());
  }

  // right side
  scatter_stretches(s, stage);
  for (int i = 0; i < static_cast<int>(bonds_.size()); ++i) change_bond(i, s);
  for (int i = 0; i < members_; ++i) change_forced(i, s);
  double* right = s.right_side.data();
  for (int i = 0; i < members_; ++i) {
    const Member& m = member_[index(i)];
    if (m.is_link) continue;
    const double* r = stage + 12 * i;
    vec(right + m.unknown) = m.mass * vec(r + 6) + vec(s.wrenches[index(i)].f);
    vec(right + m.unknown + 3) = vec(r + 9) + vec(s.wrenches[index(i)].t);
  }
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const double* kq = stage + tree_rows_[t];
    double* to = right + tree_unknowns_[t];
    trees_[t]->right_side(kq + trees_[t]->freedoms(), kq, to);
    trees_[t]->gather(s.wrenches.data(), to);
    trees_[t]->fold(to);
  }
  if (!coupled_->solve(right)) return false;

  // all unknowns
  for (int i = 0; i < members_; ++i) {
    const Member& m = member_[index(i)];
    if (m.is_link) continue;
    s.members[index(i)].take(right + m.unknown, s.changes[index(i)], stage + 12 * i);
  }
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    TreeInGroup& tree = *trees_[t];
    const std::size_t n = index(tree.freedoms());
    double *kq = stage + tree_rows_[t], *ku = kq + n;
    std::copy_n(right + tree_unknowns_[t], n, ku);
    tree.follow(ku);
    work.assign(ku, ku + n);
    tree.eliminate(work.data());
    for (std::size_t e = 0; e < n; ++e) kq[e] += work[e];
    tree.spread(kq, ku, s.changes.data());
  }
  solve_stretches(s, stage);
  return true;
}

}  // namespace tw
