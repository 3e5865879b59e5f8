#include "variants/opencl/device_problem.hpp"

#include "solver/error.hpp"
#include "solver/model/link_constants.hpp"
#include "variants/engine/packs.hpp"
#include "variants/engine/step_error.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

namespace dss::opencl {

Layout layout_on(const Device& device, Precision precision, int threads) {
  const bool is_cpu = device.is_cpu && !is_taken_for("gpu");
  if (!is_cpu) return {true, 16, 1};
  const int narrow = precision == Precision::f64 ? 4 : 8;
  return {false, device.vector_width(precision) > narrow ? 2 * narrow : narrow, threads};
}

template <class T, int W>
DeviceProblem<T, W>::DeviceProblem(const Problem& problem, Model model, const Part* part,
                                   const Device& device, const Layout& where)
    : packed(problem, model, part, memory), layout(where), queue(device), problem_(problem),
      model_(model), part_(part), is_shared_(device.is_unified && !where.has_items) {}

template <class T, int W>
DeviceProblem<T, W>::~DeviceProblem() {
  mapping_.reset();
  try {
    queue.finish();
  } catch (const InputError&) { // the call that met the error first has reported it
  }
}

template <class T, int W>
int DeviceProblem<T, W>::shape_of(const Terms& terms) {
  const auto found = std::find(terms_.begin(), terms_.end(), terms);
  if (found != terms_.end()) return int(found - terms_.begin());
  terms_.push_back(terms);
  return int(terms_.size()) - 1;
}

/// Offset at which row r finds its lower row. The rows that work-items read follow one another in
/// memory, in the order of their numbers.
template <class T, int W>
long DeviceProblem<T, W>::lower(long in, int r, int lower, int fields) const {
  if (lower < 0) return -1;
  const PackedRow<T>&from = packed.rows[std::size_t(lower)], &to = packed.rows[std::size_t(r)];
  return in + (long(from.pack_offset) - long(to.pack_offset) + to.first_pack - from.first_pack) *
                  fields * W;
}

template <class T, int W>
int DeviceProblem<T, W>::add(const RowTask<T>& task, int r, row_action action, int fields,
                             const T* published, int sweep) {
  const PackedRow<T>& packed_row = packed.rows[std::size_t(r)];
  Row row{};
  row.in = offset(task.in);
  row.upper_y = offset(task.upper_y), row.upper_z = offset(task.upper_z);
  row.carry_y = offset(task.carry_y), row.carry_z = offset(task.carry_z);
  row.from_y = offset(task.from_y), row.from_z = offset(task.from_z);
  if (layout.has_items) {
    const dss::Row& lattice_row = packed.lattice.rows[std::size_t(r)];
    row.lower_y = lower(row.in, r, lattice_row.lower_y, fields),
    row.lower_z = lower(row.in, r, lattice_row.lower_z, fields);
  }
  row.base = offset(task.base), row.out = offset(task.out);
  static_assert(std::extent_v<decltype(row.alpha)> == RowTask<T>::most_increments);
  for (std::size_t m = 0; m < std::size(task.alpha); ++m)
    row.increment[m] = offset(task.increment[m]), row.alpha[m] = task.alpha[m];
  row.published = offset(published);
  row.action = action;
  actions_.insert(action);
  row.is_last = task.is_last, row.low = task.low, row.increments = task.increments;
  row.shape = shape_of(packed_row.shape.terms);
  row.body = packed.lattice.rows[std::size_t(r)].body;
  row.applied = packed_row.applied == nullptr ? -1 : r;
  row.face_strains =
      packed_row.pressure == nullptr || packed_row.pressure->loads == nullptr ? -1 : r;
  row.rest = offset(packed_row.rest);
  row.inverse_ratios = offset(packed_row.inverse_ratios);
  row.packs = packed_row.packs, row.first_pack = packed_row.first_pack;
  row.masks = int(packed_row.pack_offset);
  row.fields = fields, row.state_fields = fields - packed.pressure_fields;
  row.row = r;
  row.sweep = sweep;
  row.beta = task.beta;
  rows_.push_back(row);
  return int(rows_.size()) - 1;
}

template <class T, int W>
template <class Item>
Buffer DeviceProblem<T, W>::table(const std::vector<Item>& items) const {
  static const Item none{};
  const Item* const data = items.empty() ? &none : items.data(); // a buffer cannot be empty
  return queue.make_buffer(std::max<std::size_t>(1, items.size()) * sizeof(Item),
                           CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, const_cast<Item*>(data));
}

template <class T, int W>
void DeviceProblem<T, W>::make_constant_tables() {
  using K = Tables<T>;
  std::vector<typename K::body_constants> bodies(problem_.bodies.size());
  std::vector<typename K::pack_masks> masks;
  const std::vector<simd::LaneMask> own = own_lanes(packed, part_);
  std::vector<typename K::applied_row> applied(packed.rows.size()),
      face_strains(packed.rows.size());
  std::vector<typename K::pattern> patterns;
  std::vector<ushort> free_lanes;
  const auto add_patterns = [&](const Applied<T>& a, typename K::applied_row& row) {
    row = {a.first, a.packs, int(patterns.size()), a.pattern_count, -1};
    for (int n = 0; n < a.pattern_count; ++n)
      patterns.push_back({offset(a.patterns[n].values), a.patterns[n].signal, a.patterns[n].first,
                          a.patterns[n].packs});
  };
  for (std::size_t r = 0; r < packed.rows.size(); ++r) {
    const PackedRow<T>& row = packed.rows[r];
    // Both are made of one header.
    static_assert(sizeof(typename K::body_constants) == sizeof(BodyConstants<T>));
    std::memcpy(&bodies[std::size_t(packed.lattice.rows[r].body)], row.body,
                sizeof(BodyConstants<T>));
    for (int p = 0; p < row.packs; ++p) {
      const PackMasks& m = row.masks[p];
      masks.push_back({m.link_x, m.link_y, m.link_z, m.below_y, m.below_z, own[masks.size()]});
    }
    if (row.pressure != nullptr && row.pressure->loads != nullptr)
      add_patterns(*row.pressure->loads, face_strains[r]);
    if (row.applied == nullptr) continue;
    const Applied<T>& a = *row.applied;
    add_patterns(a, applied[r]);
    if (a.free_lanes == nullptr) continue;
    applied[r].free_lanes = int(free_lanes.size());
    free_lanes.insert(free_lanes.end(), a.free_lanes,
                      a.free_lanes + std::size_t(a.packs) * packed.layout.wrench.size());
  }
  bodies_ = table(bodies), masks_ = table(masks), applied_ = table(applied),
  patterns_ = table(patterns), face_strains_ = table(face_strains);
  free_lanes_ = table(free_lanes);
}

/// The constants of each lane of some kinds, as device/tables.h has them.
/// @param constants  (PackKinds, lane) -> a struct of numbers of type T
template <class T, std::size_t W, class Kinds, class Constants>
static std::vector<T> lane_table(const Kinds& all, Constants&& constants) {
  std::vector<T> numbers;
  for (const auto& kinds : all)
    for (std::size_t lane = 0; lane < W; ++lane) {
      const auto one = constants(kinds, lane);
      constexpr std::size_t count = sizeof one / sizeof(T);
      std::array<T, count> of_lane;
      std::memcpy(of_lane.data(), &one, sizeof one);
      if (lane == 0) numbers.resize(numbers.size() + count * W);
      T* const start = &numbers[numbers.size() - count * W];
      for (std::size_t n = 0; n < count; ++n) start[n * W + lane] = of_lane[n];
    }
  return numbers;
}

template <class T, int W>
void DeviceProblem<T, W>::make_link_tables() {
  static_assert(LinkTable<T, W>::faces == 6);
  links_ = table(lane_table<T, std::size_t(W)>(
      packed.links().kinds(), [&](const PackKinds<W>& face, std::size_t lane) {
        const Body& body = problem_.bodies[std::size_t(face.body)];
        LinkConstants<T> link{};
        set_material_constants(link, body.link(face.axis, face.kinds[lane]), face.axis);
        return link;
      }));
  link_index_ = table(packed.links().index());
}

template <class T, int W>
void DeviceProblem<T, W>::make_pressure_tables() {
  pressures_ = table(lane_table<T, std::size_t(W)>(
      packed.pressures().kinds(), [&](const PackKinds<W>& pack, std::size_t lane) {
        return pressure_constants<T>(problem_.bodies[std::size_t(pack.body)], pack.kinds[lane]);
      }));
  pressure_index_ = table(packed.pressures().index());
}

/// The actions to compile. All that Runge-Kutta methods may need are compiled together, so that
/// they share one program with the rates. Programs of tiles have no rates.
static std::set<row_action> compiled_actions(std::set<row_action> actions) {
  if (actions.contains(plain_stage)) actions.insert({combined_stage, wide_stage});
  if (actions.contains(kept_step)) actions.insert(kept_stage);
  return actions;
}

template <class T, int W>
void DeviceProblem<T, W>::finish() {
  const Device& device = queue.device();
  const ProgramKind kind{model_,
                         sizeof(T) == 8 ? Precision::f64 : Precision::f32,
                         W,
                         layout.has_items,
                         tile_.is_used() ? actions_ : compiled_actions(actions_),
                         terms_,
                         tile_,
                         packed.links().is_mixed()};
  program_ = build_program(device, row_program(kind));
  build_s_ += program_.build_s, is_cached_ &= program_.is_cached;
  if (has_extra_links()) {
    extra_program_ = build_program(device, extra_link_program(kind));
    build_s_ += extra_program_.build_s, is_cached_ &= extra_program_.is_cached;
    extra_table_ = table(extra_);
    extra_kernel_ = queue.make_kernel(extra_program_, "evaluate_extra_links");
  }
  make_constant_tables();
  make_link_tables();
  make_pressure_tables();
  row_table_ = table(rows_);
  arena_ = is_shared_ ? queue.make_buffer(memory.bytes(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR,
                                          memory.start())
                      : queue.make_buffer(memory.bytes());
  if (!is_shared_) queue.write(arena_, 0, {memory.start(), memory.bytes()});
  if (tile_.is_used()) return require_tile();
  if (!layout.has_items) return;
  const auto items = std::size_t(packed.packs_across * W);
  group_size_ = std::min(items, largest_group());
  items_across_ = (items + group_size_ - 1) / group_size_ * group_size_;
}

/// 64 are as good on small scenes, 256 on large ones (README.md).
constexpr std::size_t group_of_rows = 128;

/// Work-items that a group of a kernel can have.
template <class T, int W>
std::size_t DeviceProblem<T, W>::most_items(const char* name) const {
  return guarded(queue.device().entry.name, [&] {
    return kernel(name).handle().template getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(
        queue.device().handle);
  });
}

/// Work-items of a group: at most what the kernel allows, in multiples of the lanes of a pack.
template <class T, int W>
std::size_t DeviceProblem<T, W>::largest_group() const {
  const std::size_t most = std::min(group_of_rows, most_items("run_rows"));
  if (most < W)
    throw InputError(
        "opencl: " + queue.device().entry.name + ": its work-groups hold " + std::to_string(most) +
        " work-items of these kernels, fewer than the 16 lanes of a pack; take another device");
  return most / W * W;
}

template <class T, int W>
void DeviceProblem<T, W>::require_tile() const {
  const int items = tile_.width * tile_.height;
  if (const std::size_t most = most_items("run_tiles"); most < std::size_t(items))
    throw InputError("opencl: " + queue.device().entry.name + ": its work-groups hold " +
                     std::to_string(most) + " work-items of these kernels, the tile has " +
                     std::to_string(items) + "; set DSSBENCH_STAGE_TILE=0");
}

template <class T, int W>
Kernel DeviceProblem<T, W>::kernel(const char* name) const {
  Kernel kernel = queue.make_kernel(program_, name);
  kernel.set(arena_, row_table_, bodies_, masks_, applied_, patterns_, free_lanes_, links_,
             link_index_, pressures_, pressure_index_, face_strains_, T(1));
  return kernel;
}

template <class T, int W>
cl::Event DeviceProblem<T, W>::launch(Queue& by, const Kernel& kernel, int bands,
                                      const Events& after) {
  const auto count = std::size_t(bands);
  cl::Event end;
  if (!layout.has_items)
    by.launch(kernel, cl::NDRange(count), cl::NDRange(1), &after, &end);
  else
    by.launch(kernel, cl::NDRange(group_size_, count), cl::NDRange(group_size_, 1), &after, &end);
  return end;
}

template <class T, int W>
void DeviceProblem<T, W>::launch_rows(const Kernel& kernel, int bands) {
  const auto count = std::size_t(bands);
  if (!layout.has_items)
    queue.launch(kernel, cl::NDRange(count), cl::NDRange(1));
  else
    queue.launch(kernel, cl::NDRange(items_across_, count), cl::NDRange(group_size_, 1));
}

template <class T, int W>
void DeviceProblem<T, W>::launch_tiles(const Kernel& kernel) {
  const std::size_t width(tile_.width), height(tile_.height);
  queue.launch(kernel,
               cl::NDRange(std::size_t(tile_.groups_across(packed.packs_across * W)) * width,
                           std::size_t(tile_.groups_along(int(packed.rows.size()))) * height),
               cl::NDRange(width, height));
}

/// The queue is in order: a wait for the last transfer is a wait for all.
static Wait wait_for(bool is_last) { return is_last ? Wait::yes : Wait::no; }

template <class T, int W>
void DeviceProblem<T, W>::to_host(std::span<const Range> ranges) {
  if (is_shared_) {
    if (mapping_ == nullptr)
      mapping_.reset(new Mapping(queue.map(arena_, 0, arena_.bytes(), CL_MAP_READ | CL_MAP_WRITE)));
    return;
  }
  for (const Range& range : ranges) {
    auto* const from = reinterpret_cast<std::byte*>(const_cast<T*>(range.from));
    const std::size_t bytes = std::size_t(range.to - range.from) * sizeof(T);
    queue.read(arena_, std::size_t(from - memory.start()), {from, bytes},
               wait_for(&range == &ranges.back()));
  }
}

template <class T, int W>
void DeviceProblem<T, W>::to_device(std::span<const Range> ranges) {
  mapping_.reset();
  if (is_shared_) return;
  for (const Range& range : ranges) {
    const auto* const from = reinterpret_cast<const std::byte*>(range.from);
    queue.write(arena_, std::size_t(from - memory.start()),
                {from, std::size_t(range.to - range.from) * sizeof(T)},
                wait_for(&range == &ranges.back()));
  }
}

template <class T, int W>
void DeviceProblem<T, W>::set_signals(std::span<const double> rows, std::size_t width) {
  signal_values_.clear();
  for (std::size_t at = 0; at < rows.size(); at += width) {
    for (std::size_t n = 0; n < width; ++n) signal_values_.push_back(T(rows[at + n]));
    signal_values_.push_back(T(1));
  }
  const std::size_t bytes = signal_values_.size() * sizeof(T);
  if (signals_.bytes() < bytes) signals_ = queue.make_buffer(bytes, CL_MEM_READ_ONLY);
  queue.write(signals_, 0, std::as_bytes(std::span(signal_values_)));
}

template <class T, int W>
void DeviceProblem<T, W>::add_extra_links(const Problem& problem, int fields) {
  const int components = int(packed.layout.wrench.size());
  for (const ExtraLink& link : problem.extra_links) {
    const ExtraLinkConstants<T> c = extra_link_constants<T>(problem, link);
    const Place i = place_of(packed, link.i), j = place_of(packed, link.j);
    const auto lane = [](const Place& place, int numbers) {
      return place.pack * numbers * W + place.lane;
    };
    typename Tables<T>::extra_link entry{};
    entry.is_material = c.is_material, entry.axis = c.axis;
    entry.row_i = int(i.row), entry.row_j = int(j.row);
    entry.lane_i = lane(i, fields), entry.lane_j = lane(j, fields);
    entry.wrench_i = offset(packed.extra_wrench(i.row)) + lane(i, components);
    entry.wrench_j = offset(packed.extra_wrench(j.row)) + lane(j, components);
    entry.edge_i = c.edge_i, entry.edge_j = c.edge_j, entry.unit = c.unit;
    std::memcpy(&entry.body, &c.body, sizeof entry.body);
    extra_.push_back(entry);
  }
}

template <class T, int W>
void DeviceProblem<T, W>::evaluate_extra_links(const Buffer& row_starts) {
  extra_kernel_.set(arena_, extra_table_, cl_int(extra_.size()), row_starts);
  queue.launch(extra_kernel_, cl::NDRange(1), cl::NDRange(1));
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template class DeviceProblem<T, W>;                                                              \
  template Buffer DeviceProblem<T, W>::table(const std::vector<cl_int2>&) const;                   \
  template Buffer DeviceProblem<T, W>::table(const std::vector<cl_long>&) const;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
