#include "report/trace/trace_hdf5.h"

#include <algorithm>

#include <fmt/format.h>
#include <hdf5.h>

#include "core/error.h"

namespace understudy::report {
namespace {

constexpr hsize_t kChunk = 16'384;  // values: 128 KiB, which a reader unpacks at once
constexpr unsigned kPacking = 6;    // of zlib, 1 to 9

/// An object of the library, closed with its owner.
class Held {
 public:
  using Close = herr_t (*)(hid_t);
  Held(hid_t id, Close close) : id_(id), close_(close) {
    if (id < 0) throw MachineError("the HDF5 library could not make the table");
  }
  ~Held() { close_(id_); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t status) {
  if (status < 0) throw MachineError("the HDF5 library could not write the table");
}

void put_text(hid_t object, const std::string& name, const std::string& text) {
  const Held type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type.get(), H5T_VARIABLE));
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8));
  const Held space(H5Screate(H5S_SCALAR), H5Sclose);
  const Held attribute(H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
  const char* const words = text.c_str();
  check(H5Awrite(attribute.get(), type.get(), &words));
}

/// "tip_error_um" is in um; a column without such an ending has no unit.
std::string unit_of(const std::string& column) {
  for (const char* unit : {"s", "mm", "um", "mrad", "deg"})
    if (column.ends_with(std::string("_") + unit)) return unit;
  return "1";
}

hid_t type_in_file(const std::string& column) {
  if (column == "line") return H5T_STD_I32LE;
  if (column == "extruding") return H5T_STD_U8LE;
  return H5T_IEEE_F64LE;
}

void put_column(hid_t group, const std::string& name, const std::vector<double>& values) {
  const hsize_t count = values.size(), chunk = std::min(count, kChunk);
  const Held space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Held made(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_obj_track_times(made.get(), false));  // the bytes do not tell when
  check(H5Pset_chunk(made.get(), 1, &chunk));
  check(H5Pset_shuffle(made.get()));
  check(H5Pset_deflate(made.get(), kPacking));
  const Held set(
      H5Dcreate2(group, name.c_str(), type_in_file(name), space.get(), H5P_DEFAULT, made.get(), H5P_DEFAULT),
      H5Dclose);
  check(H5Dwrite(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  put_text(set.get(), "unit", unit_of(name));
}

/// A file in memory: its bytes are written by us, whole.
Held open_in_memory() {
  const Held access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  check(H5Pset_fapl_core(access.get(), 1 << 20, false));
  return {H5Fcreate("trace", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose};
}

}  // namespace

std::string loaded_hdf5() {
  unsigned major = 0, minor = 0, release = 0;
  check(H5get_libversion(&major, &minor, &release));
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string trace_hdf5(const TraceTable& table,
                       const std::vector<std::pair<std::string, std::string>>& attributes) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are ours to tell
  const Held file = open_in_memory();
  for (const auto& [key, text] : attributes) put_text(file.get(), key, text);
  {
    const Held group(H5Gcreate2(file.get(), "trace", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    for (std::size_t c = 0; c < table.names.size(); ++c)
      put_column(group.get(), table.names[c], table.columns[c]);
  }
  check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL));
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  if (size <= 0) throw MachineError("the HDF5 library could not write the table");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  check(static_cast<herr_t>(std::min<ssize_t>(0, H5Fget_file_image(file.get(), bytes.data(), bytes.size()))));
  return bytes;
}

}  // namespace understudy::report
