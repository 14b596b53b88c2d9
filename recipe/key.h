#pragma once
// Merkle keys: the name of a stage's result, made from everything that the result depends on.
#include "volume/base/types.h"

#include <compare>
#include <span>
#include <string>
#include <string_view>

namespace pith {

/// 128 bits that stand for a content. Not made against forgers, only against accidents.
struct Key {
  std::uint64_t high = 0, low = 0;
  auto operator<=>(const Key&) const = default;
  std::string text() const; ///< 32 hexadecimal digits
};

/// Reads Key::text() back; zeros for anything else.
Key key_from(std::string_view text);

/// MurmurHash3's 128-bit variant for 64-bit machines (Appleby 2011).
Key key_of(std::string_view bytes, std::uint64_t seed = 0);

/// Collects what a result depends on, in order; every item is written with its kind and length, so that different
/// lists never look alike.
class KeyMaker {
public:
  explicit KeyMaker(std::string_view stage) { add(stage); }
  KeyMaker& add(std::string_view text);
  KeyMaker& add(const char* text) { return add(std::string_view(text)); }
  KeyMaker& add(const Key& key);
  KeyMaker& add(double number);
  KeyMaker& add(std::uint64_t number);
  KeyMaker& add(int number) { return add(static_cast<std::uint64_t>(static_cast<std::int64_t>(number))); }
  KeyMaker& add(bool flag) { return add(static_cast<std::uint64_t>(flag)); }
  KeyMaker& add(const Vec3d& v) { return add(v.x()).add(v.y()).add(v.z()); }
  KeyMaker& add(const Vec2d& v) { return add(v.x()).add(v.y()); }
  template <class Point>
  KeyMaker& add(const std::vector<Point>& points) {
    add(static_cast<std::uint64_t>(points.size()));
    for (const Point& point : points) add(point);
    return *this;
  }
  Key key() const { return key_of(bytes_); }

private:
  std::string bytes_;
};

/// What stands for "this version of the code" in keys: the linker's build id of the running program, or the key of
/// its bytes where there is none. A cache entry made by another build is never taken.
std::string code_version();

} // namespace pith
