// The code for parts, lines, arrows and volumes. It is loaded with the first display that has some.

import * as cells from '../layers/part_cells';
import {partCells} from '../layers/parts';
import {arrows, lines} from '../lines/shown_lines';
import {lateMaking} from '../picture/late_making';
import {volumeCells} from '../picture/volume_cells';

Object.assign(partCells, cells);
Object.assign(lateMaking, {lines, arrows, volume: volumeCells});
