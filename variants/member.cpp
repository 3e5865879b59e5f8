#include "variants/member.hpp"
