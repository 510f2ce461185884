#include "host/labeling/evaluation.h"
