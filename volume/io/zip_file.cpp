#include "volume/io/zip_file.h"

#include "volume/io/atomic_file.h"

#include <algorithm>
#include <zip.h>

namespace pith {

namespace {

// Midnight of the first of January 1980, the earliest that a zip can hold.
constexpr zip_uint16_t fixed_date = (0 << 9) | (1 << 5) | 1, fixed_time = 0;
constexpr std::size_t most_text = 64 << 20; // bytes; JSON that pith writes stays far below
constexpr std::size_t header_bytes = 4096;  // enough for the header of any array that pith writes
constexpr std::size_t deflate_ratio = 1032; // no deflated stream grows more than that

struct Error {
  zip_error_t error;
  Error() { zip_error_init(&error); }
  ~Error() { zip_error_fini(&error); }
  std::string text() { return zip_error_strerror(&error); }
};

} // namespace

void ZipWriter::add_text(const std::string& name, std::string text) {
  entry_.push_back({name, std::move(text), {}, Packing::deflated});
}

void ZipWriter::add_bytes(const std::string& name, std::string head, std::span<const std::byte> data,
                          Packing packing) {
  entry_.push_back({name, std::move(head), data, packing});
}

std::size_t ZipWriter::total_bytes() const {
  std::size_t bytes = 0;
  for (const Entry& entry : entry_) bytes += entry.head.size() + entry.data.size();
  return bytes;
}

void ZipWriter::write(const std::filesystem::path& path) const {
  AtomicFile file(path); // first, so that a path that cannot be written is found before the work
  Error error;
  const auto check = [&](bool good) {
    if (!good) throw IoFailure(path.string(), "cannot be packed: " + error.text() + "; free memory");
  };
  // The zip is made in memory, then written: libzip's own files would have random names beside the final one.
  const auto free_source = [](zip_source_t* source) { zip_source_free(source); };
  std::unique_ptr<zip_source_t, decltype(free_source)> memory(zip_source_buffer_create(nullptr, 0, 0, &error.error),
                                                              free_source);
  check(memory != nullptr);
  zip_source_keep(memory.get());
  const auto discard = [](zip_t* zip) { zip_discard(zip); };
  std::unique_ptr<zip_t, decltype(discard)> zip(zip_open_from_source(memory.get(), ZIP_TRUNCATE, &error.error),
                                                discard);
  if (!zip) zip_source_free(memory.get());
  check(zip != nullptr);

  std::deque<std::array<zip_buffer_fragment_t, 2>> fragments; // libzip keeps pointers to them
  for (const Entry& entry : entry_) {
    auto& part = fragments.emplace_back();
    const auto bytes = [](const void* data) { return static_cast<zip_uint8_t*>(const_cast<void*>(data)); };
    part[0] = {bytes(entry.head.data()), entry.head.size()};
    part[1] = {bytes(entry.data.data()), entry.data.size()};
    const zip_uint64_t count = entry.data.empty() ? 1 : 2;
    zip_source_t* source = zip_source_buffer_fragment_create(part.data(), count, 0, &error.error);
    check(source != nullptr);
    const zip_int64_t index = zip_file_add(zip.get(), entry.name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) zip_source_free(source);
    const bool packed = entry.packing == Packing::deflated;
    if (index < 0 ||
        zip_set_file_compression(zip.get(), index, packed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, packed ? 1 : 0) != 0 ||
        zip_file_set_dostime(zip.get(), index, fixed_time, fixed_date, 0) != 0)
      throw IoFailure(path.string(), std::string("cannot be packed: ") + zip_strerror(zip.get()) + "; free memory");
  }
  if (zip_close(zip.get()) != 0)
    throw IoFailure(path.string(), std::string("cannot be packed: ") + zip_strerror(zip.get()) + "; free memory");
  zip.release();

  if (zip_source_open(memory.get()) != 0) throw IoFailure(path.string(), "cannot be packed; free memory");
  std::vector<char> block(1 << 20);
  for (;;) {
    const zip_int64_t got = zip_source_read(memory.get(), block.data(), block.size());
    if (got < 0) throw IoFailure(path.string(), "cannot be packed; free memory");
    if (got == 0) break;
    file.write(block.data(), static_cast<std::size_t>(got));
  }
  zip_source_close(memory.get());
  file.commit();
}

struct ZipReader::Handle {
  zip_t* zip = nullptr;
  zip_file_t* open = nullptr;
  void close() {
    if (open) zip_fclose(open);
    open = nullptr;
  }
  ~Handle() {
    close();
    if (zip) zip_discard(zip);
  }
};

ZipReader::ZipReader(const std::filesystem::path& path, std::string kind, std::string mend)
    : path_(path.string()), kind_(std::move(kind)), mend_(std::move(mend)), handle_(std::make_unique<Handle>()) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw IoFailure(path_, "there is no such file; check its name");
  if (!std::filesystem::is_regular_file(status)) throw IoFailure(path_, "is not a file; name one");
  file_bytes_ = std::filesystem::file_size(path, error);
  int code = 0;
  handle_->zip = zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code);
  if (handle_->zip) return;
  if (file_bytes_ == 0) fail("is empty");
  if (code == ZIP_ER_OPEN || code == ZIP_ER_READ || code == ZIP_ER_MEMORY) {
    zip_error_t reason;
    zip_error_init_with_code(&reason, code);
    const std::string text = zip_error_strerror(&reason);
    zip_error_fini(&reason);
    throw IoFailure(path_, "cannot be opened: " + text + "; check its permissions");
  }
  fail("is not a " + kind_ + ", or is cut off");
}

ZipReader::~ZipReader() = default;

void ZipReader::fail(const std::string& what) const { throw InvalidInput(path_, what, mend_); }

bool ZipReader::has(const std::string& name) const { return zip_name_locate(handle_->zip, name.c_str(), 0) >= 0; }

std::size_t ZipReader::size_of(const std::string& name) const {
  zip_stat_t about;
  zip_stat_init(&about);
  if (zip_stat(handle_->zip, name.c_str(), 0, &about) != 0) fail("is a " + kind_ + " without its part " + name);
  constexpr zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
  // A size that the file cannot hold is refused before memory is taken for it.
  const bool known =
      (about.valid & needed) == needed && (about.comp_method == ZIP_CM_STORE || about.comp_method == ZIP_CM_DEFLATE);
  const bool fits =
      about.comp_size <= file_bytes_ &&
      about.size <= (about.comp_method == ZIP_CM_STORE ? about.comp_size : (about.comp_size + 1) * deflate_ratio);
  if (!known || !fits) fail("is damaged at its part " + name);
  return about.size;
}

void ZipReader::open(const std::string& name) const {
  handle_->close();
  handle_->open = zip_fopen(handle_->zip, name.c_str(), 0);
  if (!handle_->open) fail("is damaged at its part " + name + " (" + zip_strerror(handle_->zip) + ")");
}

std::size_t ZipReader::read(const std::string& name, void* into, std::size_t bytes) const {
  std::size_t filled = 0;
  while (filled < bytes) {
    const zip_int64_t got = zip_fread(handle_->open, static_cast<char*>(into) + filled, bytes - filled);
    if (got < 0) fail("is damaged at its part " + name + " (" + zip_file_strerror(handle_->open) + ")");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  return filled;
}

void ZipReader::close_at_end(const std::string& name) const {
  char beyond; // the CRC is compared when the end is reached
  if (read(name, &beyond, 1) != 0) fail("is damaged at its part " + name);
  handle_->close();
}

std::string ZipReader::text(const std::string& name) const {
  const std::size_t size = size_of(name);
  if (size > most_text)
    fail("has " + std::to_string(size >> 20) + " MB of text in its part " + name + " where at most " +
         std::to_string(most_text >> 20) + " MB belong");
  std::string content(size, '\0');
  open(name);
  if (read(name, content.data(), content.size()) != content.size()) fail("is cut off in its part " + name);
  close_at_end(name);
  return content;
}

NpyHeader ZipReader::open_array(const std::string& name, NpyType type, const std::vector<std::size_t>& shape,
                                std::string& first) const {
  const std::string entry = name + ".npy";
  const std::size_t size = size_of(entry);
  open(entry);
  first.resize(std::min(size, header_bytes));
  first.resize(read(entry, first.data(), first.size()));
  const NpyHeader header = npy_header_of(first, size, path_ + ", part " + entry);
  bool fits = header.type == type && !header.swapped && header.shape.size() == shape.size();
  for (std::size_t i = 0; fits && i < shape.size(); ++i) fits = shape[i] == any || shape[i] == header.shape[i];
  if (!fits) {
    std::string wanted, found;
    for (const std::size_t n : shape) wanted += (wanted.empty() ? "" : " × ") + (n == any ? "n" : std::to_string(n));
    for (const std::size_t n : header.shape) found += (found.empty() ? "" : " × ") + std::to_string(n);
    fail("has " + found + " " + name_of(header.type) + " in its part " + entry + " where " + wanted + " " +
         name_of(type) + " belong");
  }
  return header;
}

void ZipReader::read_numbers(const std::string& name, const NpyHeader& header, std::string& first,
                             std::span<std::byte> into) const {
  const std::string entry = name + ".npy";
  const std::size_t have = std::min(first.size() - header.data_begin, into.size());
  if (have > 0) std::memcpy(into.data(), first.data() + header.data_begin, have);
  if (read(entry, into.data() + have, into.size() - have) != into.size() - have)
    fail("is cut off in its part " + entry);
  close_at_end(entry);
}

} // namespace pith
