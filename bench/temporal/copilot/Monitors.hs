-- What a user of Copilot would write for some of the formulas, on robustness in floats. Writes
-- NAME.c, NAME.h and NAME_types.h for each into the folder that it is given.
{-# LANGUAGE RebindableSyntax #-}
module Main where

import Copilot.Compile.C99 (CSettings (..), compileWith, mkDefaultCSettings)
import Language.Copilot hiding (always, eventually)
import qualified Prelude as P
import System.Environment (getArgs)

p, q, r :: Stream Float
p = extern "copilot_p" Nothing
q = extern "copilot_q" Nothing
r = extern "copilot_r" Nothing

infinity :: Float
infinity = 1 P./ 0

larger, smaller :: Stream Float -> Stream Float -> Stream Float
larger a b = local a $ \x -> local b $ \y -> mux (x < y) y x
smaller a b = local a $ \x -> local b $ \y -> mux (y < x) y x

-- | The value of n steps ago; at first the fill.
before :: Int -> Float -> Stream Float -> Stream Float
before n fill s = P.replicate n fill ++ s

-- | The greatest of the last n + 1.
greatestOf :: Int -> Stream Float -> Stream Float
greatestOf n s = P.foldr larger s [drop k past | k <- [0 .. n P.- 1]]
  where past = before n (P.negate infinity) s

always, eventually :: Stream Float -> Stream Float
always s = worst where worst = smaller s ([infinity] ++ worst)
eventually s = best where best = larger s ([P.negate infinity] ++ best)

-- | G (p -> F[0,50] q): positions whose window has passed, and those that wait.
response :: Stream Float
response = smaller settled pending
  where
    settled = always (mux (steps < 50) (constant infinity) passed)
    passed = larger (before 50 infinity (negate p)) (greatestOf 50 q)
    pending = larger (smaller ([infinity] ++ pending) (negate p)) q
    steps = [0] ++ mux (steps < 50) (steps + 1) steps :: Stream Word32

monitors :: [(String, Stream Float)]
monitors =
  [ ("invariant", always p)
  , ("eventually_50", greatestOf 50 p)
  , ("sequence", eventually (smaller (eventually (smaller (eventually p) q)) r))
  , ("response_50", response)
  ]

main :: IO ()
main = do
  [folder] <- getArgs
  mapM_ (write folder) monitors

write :: P.FilePath -> (String, Stream Float) -> IO ()
write folder (name, s) =
  reify (trigger (file P.++ "_rho") true [arg s]) P.>>= compileWith settings file
  where
    file = "copilot_" P.++ name
    settings = mkDefaultCSettings
      {cSettingsStepFunctionName = file P.++ "_step", cSettingsOutputDirectory = folder}
