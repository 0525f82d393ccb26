"""What more than one test needs: truths to judge the package by, scenes, tables, places."""
