#include "shared_world.hpp"

#include <algorithm>
#include <numeric>

#include "beside_contact.hpp"
#include "quadcore/plugin/error.hpp"
#include "sdf_conversion.hpp"

namespace quadcore {
namespace {

/// Distance by which an impact may stretch a vehicle [m].
constexpr double stretch = 0.05;

bool has_any(const std::vector<char>& flags) {
  return std::any_of(flags.begin(), flags.end(), [](char flag) { return flag != 0; });
}

}  // namespace

OdeSharedWorld::OdeSharedWorld(const std::vector<OdeEngine*>& engines, const World& world)
    : SharedWorld({engines.begin(), engines.end()}), free_(world) {
  std::vector<const Model*> models;
  for (OdeEngine* const engine : engines) {
    const Model& model = engine->bodies().model;
    models.push_back(&model);
    vehicles_.push_back({engine, bodies_.size(), first_joint_, reach_of_shapes(model)});
    first_joint_ += engine->warm_start().size();
    const std::vector<dBodyID>& bodies = engine->vehicle().bodies();
    bodies_.insert(bodies_.end(), bodies.begin(), bodies.end());
    owners_.resize(bodies_.size(), vehicles_.size() - 1);
    engine->expect_contact();
  }
  first_free_ = bodies_.size();
  bodies_.insert(bodies_.end(), free_.bodies().begin(), free_.bodies().end());
  contact_ = std::make_unique<WorldContact>(models, bodies_, world);
  create_step(world);
  positions_W_.resize(vehicles_.size());
  for (std::vector<char>* const flags : {&close_, &touching_, &near_free_}) {
    flags->resize(vehicles_.size());
  }
}

/// Create the sweeps over all bodies. The free ones are the oldest, the last vehicle is the newest.
void OdeSharedWorld::create_step(const World& world) {
  std::vector<Hinge> hinges;
  std::vector<GazeboStep::Damping> damping;
  std::vector<std::size_t> order(free_.bodies().size());
  std::iota(order.begin(), order.end(), first_free_);
  for (const Vehicle& vehicle : vehicles_) {
    const std::size_t first = vehicle.first_body;
    for (Hinge hinge : vehicle.engine->vehicle().hinge_rows()) {
      hinge.child += first;
      hinge.parent += first;
      hinges.push_back(hinge);
    }
    const Model& model = vehicle.engine->bodies().model;
    for (const Link& link : model.links) {
      damping.push_back({link.tags.damping_factor, link.tags.damping_factor});
    }
    for (const std::size_t body : sdf_order(model)) order.push_back(first + body);
  }
  for (const Hinge& joint : free_.hinge_rows(first_free_)) hinges.push_back(joint);
  for (const GazeboStep::Damping& of_free : free_.damping()) damping.push_back(of_free);
  step_ = std::make_unique<GazeboStep>(
      bodies_, std::move(hinges), order,
      gazebo_options(world, vehicles_.front().engine->recipe(), std::move(damping)), first_free_);
}

void OdeSharedWorld::step(double dt, const std::vector<TimedForces>& forces) {
  for (current_ = 0; current_ < vehicles_.size(); ++current_) {
    vehicles_[current_].engine->evaluate(forces[current_].time, *forces[current_].field);
  }
  find_close(dt);
  std::fill(touching_.begin(), touching_.end(), 0);
  const bool are_free_awake = !are_free_bodies_asleep();
  const std::vector<Contact>* contacts = nullptr;
  if (are_free_awake || has_any(close_)) {
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (close_[i]) vehicles_[i].engine->settle();
    }
    contacts = &contact_->find_among(close_, step_->unmoved);
    find_touching(*contacts);
  }
  for (current_ = 0; current_ < vehicles_.size(); ++current_) {
    if (!touching_[current_]) vehicles_[current_].engine->move(dt, near_free_[current_] != 0);
  }
  current_ = 0;
  if (are_free_awake || has_any(touching_)) step_together(*contacts, dt);
}

/// Find the vehicles that may touch another one now, or a free body within some steps.
void OdeSharedWorld::find_close(double dt) {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    const HingedVehicle& vehicle = vehicles_[i].engine->hinged();
    positions_W_[i] = vehicle.position();
    near_free_[i] = !contact_->is_clear_of_free(positions_W_[i], vehicle.velocity(),
                                                vehicles_[i].reach, steps_beside_contact * dt);
  }
  close_ = near_free_;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double reach = vehicles_[i].reach + vehicles_[k].reach + stretch;
      if ((positions_W_[i] - positions_W_[k]).squaredNorm() > reach * reach) continue;
      close_[i] = close_[k] = 1;
    }
  }
}

void OdeSharedWorld::find_touching(const std::vector<Contact>& contacts) {
  const auto touch = [this](std::size_t body) {
    if (body < first_free_) touching_[owners_[body]] = 1;
  };
  for (const Contact& contact : contacts) {
    if (contact.other < 0) continue;
    touch(contact.body);
    touch(static_cast<std::size_t>(contact.other));
  }
}

/// Move the vehicles that touch, and the free bodies. The others sleep meanwhile.
void OdeSharedWorld::step_together(const std::vector<Contact>& contacts, double dt) {
  std::vector<char>& asleep = step_->asleep;
  for (std::size_t body = 0; body < first_free_; ++body) asleep[body] = !touching_[owners_[body]];
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (!touching_[i]) continue;
    OdeEngine& engine = *vehicles_[i].engine;
    engine.push(dt);
    std::copy(engine.warm_start().begin(), engine.warm_start().end(), warm_start_of(i));
  }
  step_->reserve(contacts.size());
  free_.push();
  free_.put_to_sleep(contacts, dt, first_free_, asleep);
  step_->step(contacts, dt);
  std::fill_n(asleep.begin(), first_free_, 0);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (!touching_[i]) continue;
    OdeEngine& engine = *vehicles_[i].engine;
    std::copy_n(warm_start_of(i), engine.warm_start().size(), engine.warm_start().begin());
    engine.take_motion();
  }
}

std::vector<GazeboStep::WarmStart>::iterator OdeSharedWorld::warm_start_of(std::size_t vehicle) {
  return step_->warm_start.begin() + static_cast<std::ptrdiff_t>(vehicles_[vehicle].first_hinge);
}

bool OdeSharedWorld::are_free_bodies_asleep() const {
  const auto first = step_->asleep.begin() + static_cast<std::ptrdiff_t>(first_free_);
  return std::all_of(first, step_->asleep.end(), [](char sleeps) { return sleeps != 0; });
}

std::size_t OdeSharedWorld::saved_size() const {
  return free_.saved_size() + 2 * free_.bodies().size() +
         (step_->warm_start.size() - first_joint_) * 2 * rows_per_hinge;
}

std::vector<double> OdeSharedWorld::save() const {
  std::vector<double> saved(saved_size());
  double* to = free_.save(saved.data());
  for (std::size_t i = first_free_; i < bodies_.size(); ++i) {
    *to++ = step_->asleep[i];
    *to++ = step_->unmoved[i];
  }
  for (std::size_t i = first_joint_; i < step_->warm_start.size(); ++i) {
    const GazeboStep::WarmStart& start = step_->warm_start[i];
    to = std::copy(start.pose.begin(), start.pose.end(), to);
    to = std::copy(start.velocity.begin(), start.velocity.end(), to);
  }
  return saved;
}

void OdeSharedWorld::restore(const std::vector<double>& saved) {
  if (saved.size() != saved_size()) {
    throw InputError(
        "snapshot: it was taken in another world or engine. Restore a snapshot of this fleet.");
  }
  const double* from = free_.restore(saved.data());
  for (std::size_t i = first_free_; i < bodies_.size(); ++i) {
    step_->asleep[i] = *from++ != 0;
    step_->unmoved[i] = *from++;
  }
  for (std::size_t i = first_joint_; i < step_->warm_start.size(); ++i) {
    GazeboStep::WarmStart& start = step_->warm_start[i];
    std::copy_n(from, rows_per_hinge, start.pose.begin());
    std::copy_n(from + rows_per_hinge, rows_per_hinge, start.velocity.begin());
    from += 2 * rows_per_hinge;
  }
}

}  // namespace quadcore
