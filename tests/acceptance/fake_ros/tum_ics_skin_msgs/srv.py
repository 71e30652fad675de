getSkinCellIds = getSkinCellNeighbors = setSkinCellLedColor = None
